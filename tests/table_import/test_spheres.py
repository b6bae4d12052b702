"""Spheres and box of a study: the paper's where nothing else is said, by volume otherwise."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from table_import.slips import refused

from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.table_import.spheres import PAPER, PAPER_COUNTS, read_grading, spheres_for
from asphalt_nscd.table_import.write import SMALL, SMALL_SPHERES

ROOT = Path(__file__).parents[2]
FINE = pd.Series({0.063: 6.0, 2.0: 30.0, 4.0: 55.0, 8.0: 85.0, 11.2: 97.0, 16.0: 100.0})


def volume(counts):
    return float((counts * np.asarray(counts.index, float) ** 3).sum())


@pytest.mark.parametrize(
    ("study", "geometry", "spheres"),
    [
        ("paper", PAPER, spheres_for(PAPER)),
        ("smoke", SMALL, SMALL_SPHERES),
    ],
)
def test_paper_and_smoke_study_are_the_same_here_as_in_their_files(study, geometry, spheres):
    config = yaml.safe_load((ROOT / f"config/{study}.yaml").read_text())
    assert geometry.keys() == config["geometry"]
    assert list(spheres.box) == config["specimens"]["box_m"]
    diameters, numbers = read_counts(ROOT / config["specimens"]["counts_table"])
    assert np.allclose(1e3 * diameters, spheres.counts.index, rtol=1e-12)
    assert numbers.tolist() == spheres.counts.tolist()


@pytest.mark.parametrize("grading", [None, FINE])
def test_volume_of_spheres_goes_with_that_of_the_specimen(grading):
    prism = replace(PAPER, b=0.07, B=0.07, e=0.05, h=0.3)
    ratio = (0.07 * 0.05 * 0.3) / (0.056 * 0.025 * 0.25)
    assert volume(spheres_for(prism, grading).counts) == pytest.approx(ratio * volume(PAPER_COUNTS), rel=2e-3)


def test_spheres_of_a_cylinder_are_twice_as_large_and_fill_as_much_of_its_box():
    cylinder = Cylinder(d=0.1, h=0.15, mass=2.8, mobile_mass=0.5)
    counts = spheres_for(cylinder).counts
    assert (spheres_for(cylinder).smallest_mm, spheres_for(PAPER).smallest_mm) == (4.0, 2.0)
    assert counts.index.tolist() == (2.0 * PAPER_COUNTS.index).tolist()
    ratio = (0.1 * 0.1 * 0.15) / (0.056 * 0.025 * 0.25)
    assert volume(counts) == pytest.approx(ratio * volume(PAPER_COUNTS), rel=2e-3)


def test_masses_follow_the_sieve_curve():
    counts = spheres_for(PAPER, FINE).counts
    share = counts * np.asarray(counts.index, float) ** 3
    retained = np.array([25, 30, 12, 3])  # on 2, 4, 8 and 11.2 mm
    assert (100 * share / share.sum()).to_numpy() == pytest.approx(100 * retained / 70, abs=0.3)


@pytest.mark.parametrize("grading", [None, FINE])
def test_lattice_of_the_box_holds_the_spheres(grading):
    geometry = replace(PAPER, e=0.03, h=0.2, B=0.05, b=0.05)
    spheres = spheres_for(geometry, grading)
    diameters, numbers = 1e-3 * np.asarray(spheres.counts.index, float), spheres.counts.to_numpy()
    position, _ = random_lattice(diameters, numbers, spheres.box, np.random.default_rng(1))
    assert len(position) == spheres.counts.sum()


def test_spheres_that_do_not_fit_are_refused():
    refused(spheres_for, replace(PAPER, e=0.008), names=["10 mm", "8 mm"])
    refused(spheres_for, replace(PAPER, e=0.15, B=0.15), names=["200000"])


def test_sieve_table_with_decimal_commas(tmp_path):
    for sieves in (
        ("mm", "2", "6,3", "10"),
        ("µm", "2000", "6300", "10000"),
        ("m", "0,002", "0,0063", "0,01"),
    ):
        text = "Sieve ({});passing (%)\n{};30,5\n{};60\n{};100\n".format(*sieves)
        (tmp_path / "s.csv").write_text(text, encoding="utf-8")
        curve = read_grading(tmp_path / "s.csv")
        assert curve.index.tolist() == pytest.approx([2.0, 6.3, 10.0]) and curve.tolist() == [
            30.5,
            60.0,
            100.0,
        ]


@pytest.mark.parametrize(
    ("content", "names"),
    [
        ("Sieve (mm),passing (%)\n2,130\n4,140\n", ["line 2", "passing (%)", "'130'"]),
        ("Sieve (mm),passing (%)\n2,0.3\n4,1\n", ["1 %", "fractions"]),
        ("Sieve (mm),passing (%)\n2,30\n2,40\n", ["line 3", "2 mm"]),
        ("Sieve (mm),passing (%)\n2,30\n4,20\n", ["falls"]),
        ("Sieve (mm),passing (%)\n0.5,30\n1,100\n", ["2 mm"]),
        ("Sieve,passing (%)\n2,30\n", ["'Sieve'", "unit"]),
        ("Sieve (mm),mass\n2,30\n", ["two columns"]),
    ],
)
def test_bad_sieve_table_is_refused(tmp_path, content, names):
    (tmp_path / "s.csv").write_text(content)
    refused(read_grading, tmp_path / "s.csv", names=["s.csv", *names])
