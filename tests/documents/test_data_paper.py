"""The published tables are as the paper prints them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.store import write_table
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.reduction import reduce_table
from asphalt_nscd.measurements.tables import origin_of, read_measured
from asphalt_nscd.rheology.fitted_laws import fit_temperature
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.reconstruct import fit_published
from asphalt_nscd.study.configuration import complete_study
from studies.paper.consistent import draws
from studies.paper.smoothness import printed

PAPER = Path(__file__).parents[2] / "data" / "paper"


def column(file, name):
    return read_csv(PAPER / file).numbers(name)


def test_counts_follow_the_grading():
    """The spheres of a size stand for what lies between its sieve and the next larger one of Table 1."""
    sieve, passing = (column("table1_grading.csv", name) for name in ("diameter_mm", "passing_percent"))
    diameter, count = (column("table2_counts.csv", name) for name in ("diameter_mm", "count"))
    assert count.sum() == 14160
    assert list(sieve[5::-1]) == [*diameter, 12.5]
    retained = np.diff(passing[5::-1])
    volume = count * diameter**3
    np.testing.assert_allclose(volume / volume.sum(), retained / retained.sum(), rtol=0.02)


def test_kpa_reading_gives_asphalt_its_stiffness():
    temperatures, laws = read_published(PAPER / "table3_burgers.csv")
    assert (
        list(temperatures) == list(column("table4_errors.csv", "temperature_C")) == [-10, 0, 10, 15, 20, 30]
    )
    assert laws[0].modulus_m == pytest.approx(39.8e9)
    norms = [abs(law.complex_modulus(2 * np.pi * 10)) for law in laws]
    assert norms == sorted(norms, reverse=True)


@pytest.fixture
def digitised(tmp_path):
    """A stand-in for Figs. 9 and 10 read off: drawn to meet Tables 3 and 4, in the columns that the README asks for."""
    temperatures, known = zip(
        *printed(PAPER / "table3_burgers.csv", PAPER / "table4_errors.csv"), strict=True
    )
    law, omega = fit_published(PAPER / "table3_burgers.csv")[1].law, known[0].omega
    smooth = np.log(np.array([law.complex_modulus(omega, t) for t in temperatures]))
    modulus = np.exp(draws(known, smooth, 0.01, 1, seed=1)[0])
    temperature, frequency = np.meshgrid(temperatures, omega / (2.0 * np.pi), indexing="ij")
    columns = {
        "specimen": "mean",
        "temperature_C": temperature.ravel(),
        "frequency_Hz": frequency.ravel().round(9),
        "E_MPa": np.abs(modulus).ravel() / 1e6,
        "phase_deg": np.degrees(np.angle(modulus)).ravel(),
        "origin": "digitised",
    }
    assert all(f"`{name}`" in (PAPER / "README.md").read_text() for name in (*columns, "digitised"))
    path = tmp_path / "digitised.csv"
    write_table(path, pd.DataFrame(columns))
    return path


def test_a_digitised_table_takes_the_place_of_the_reconstruction(digitised, tmp_path):
    """Tables 3 and 4 come out of it, by the steps of the study."""
    study = yaml.safe_load((PAPER.parents[1] / "config/paper.yaml").read_text())
    study["measurements"] = yaml.safe_load("{table: digitised.csv}".replace("digitised.csv", str(digitised)))
    assert complete_study(study, "paper.yaml")["measurements"]["table"] == str(digitised)
    reduce_table(digitised, study["geometry"], tmp_path / "measured.csv")
    data = read_measured([tmp_path / "measured.csv"])
    assert origin_of(data) == "digitised" and len(data) == 30
    fit_temperature(tmp_path / "measured.csv", 15.0, tmp_path / "T15.json")
    temperatures, laws = read_published(PAPER / "table3_burgers.csv")
    assert read_law(tmp_path / "T15.json").modulus_m == pytest.approx(laws[3].modulus_m, rel=1e-3)
    of_laws = []
    for temperature, law in zip(temperatures, laws, strict=True):
        at = data[data["temperature_C"] == temperature]
        modulus = law.complex_modulus(2.0 * np.pi * at["frequency_Hz"].to_numpy())
        of_laws.append(at.assign(E_MPa=np.abs(modulus) / 1e6, phase_deg=np.degrees(np.angle(modulus))))
    errors = mean_relative_error(data, pd.concat(of_laws))
    for quantity in ("E", "phase"):
        name = f"mre_{quantity}_percent"
        np.testing.assert_allclose(errors[name], column("table4_errors.csv", name), atol=1e-3)
