"""`new-study` from table to a configuration that the workflow accepts."""

from __future__ import annotations

import cmath
import itertools
import math
from pathlib import Path

import pandas as pd
import pytest
import yaml
from table_import.slips import refused, workbook

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.study.configuration import complete_study
from asphalt_nscd.study.preflight import require_feasible
from asphalt_nscd.table_import.write import StudyOptions, new_study

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
PRISM = {"b_mm": 50, "B_mm": 50, "e_mm": 50, "h_mm": 300, "mass_kg": 1.8, "mobile_mass_kg": 0.2}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


HEADER = ["Sample", "Temp °C", "f (Hz)", "|E*| [GPa]", "delta_rad"]
DIRECT = "tension-compression"


def rows(temperatures=(10, 15), frequencies=(1, 10), specimens=(1, 2)):
    for specimen, temperature, frequency in itertools.product(specimens, temperatures, frequencies):
        size, phase = cmath.polar(complex(LAW.complex_modulus(2 * math.pi * frequency)))
        yield specimen, temperature, frequency, size * 1e-9, phase


def german(tests):
    lines = [f"{s};{t};{f};{e:.4f};{p:.5f}".replace(".", ",") for s, t, f, e, p in tests]
    Path("t.csv").write_text("\n".join([";".join(HEADER), *lines]) + "\n", encoding="utf-8")
    return [Path("t.csv")]


def made(name="mine", tests=None, **options):
    """The study that the workflow accepts."""
    return accepted(new_study(name, german(rows() if tests is None else tests), StudyOptions(**options))[0])


def accepted(config):
    study = complete_study(yaml.safe_load(config.read_text(encoding="utf-8")), str(config))
    require_feasible(study, str(config))
    return study


def test_german_table_becomes_a_full_size_study():
    study = made()
    assert (study["temperatures_C"], study["frequencies_Hz"]) == ([10, 15], [1, 10])
    assert study["specimens"]["seeds"] == [1, 2, 3, 4]
    assert study["specimens"]["bonds"]["area"] == "facets"
    assert study["test"]["time_step_s"] == 2e-4  # a five-hundredth of 10 Hz, and the coarsest
    assert study["sensitivity"]["temperature_C"] == 15  # the middle one
    counts = read_csv(study["specimens"]["counts_table"]).columns["count"]
    assert counts == ["11798", "1588", "492", "211", "71"]
    table = read_csv("data/mine/measurements.csv")
    expected = [1e3 * modulus for *_, modulus, _ in rows()]
    assert table.numbers("E_MPa").tolist() == pytest.approx(expected, rel=1e-4)
    assert table.numbers("phase_deg")[0] == pytest.approx(math.degrees(next(rows())[4]), rel=1e-4)


def test_workbook_becomes_the_same_table():
    made("csv")
    cells = [[s, t, f, round(e, 4), round(p, 5)] for s, t, f, e, p in rows()]
    new_study("xlsx", [workbook(Path("t.xlsx"), results=[HEADER, *cells])], StudyOptions())
    assert Path("data/csv/measurements.csv").read_bytes() == Path("data/xlsx/measurements.csv").read_bytes()


def test_small_study_keeps_the_measured_geometry_beside_the_simulated_one():
    study = made(geometry=PRISM, small=True)
    assert study["geometry"] == PRISM
    assert study["specimens"]["geometry"]["h_mm"] == 60
    assert study["specimens"]["seeds"] == [1]


def test_of_several_geometries_the_first_is_simulated():
    keys = list(PRISM)
    lines = [f"{s},50,{foot},50,300,1.8,0.2" for s, foot in ((2, 60), (1, 70))]
    Path("g.csv").write_text("\n".join([",".join(["specimen", *keys]), *lines]) + "\n")
    assert made(geometry=Path("g.csv"))["specimens"]["geometry"]["B_mm"] == 70


def test_prism_is_simulated_as_a_prism():
    study = made(geometry=PRISM)
    assert study["specimens"]["geometry"] == PRISM
    assert study["specimens"]["box_m"][:2] == [0.3, 0.05]


def test_direct_tests_are_simulated_on_a_cylinder():
    ampt = made("ampt", measured_in=DIRECT)
    assert ampt["diagnosis"]["measured_in"] == DIRECT
    assert ampt["specimens"]["geometry"] == {"d_mm": 100, "h_mm": 150, "mass_kg": 2.83, "mobile_mass_kg": 0}
    assert ampt["test"]["amplitude_m"] == pytest.approx(50e-6 * 0.15)
    assert (ampt["test"]["type"], ampt["test"]["steps_per_cycle"]) == (DIRECT, 200)
    counts = pd.read_csv(ampt["specimens"]["counts_table"])
    assert counts["diameter_mm"].tolist() == [4.0, 8.0, 12.6, 16.0, 20.0]
    assert 7000 < counts["count"].sum() < 8000
    given = {"d_mm": 60.0, "h_mm": 120.0, "mass_kg": 0.8, "mobile_mass_kg": 0.1}
    assert made("other", measured_in=DIRECT, geometry=given)["specimens"]["geometry"] == given
    assert made("small", measured_in=DIRECT, small=True)["specimens"]["geometry"]["d_mm"] == 18
    refused(made, "bent", geometry=given, names=[DIRECT, "--measured-in"])


def peaks():
    tests = "15,10,60,50,20\n15,25,65,50,18\n20,10,50,50,25\n20,25,55,60,22\n"
    Path("p.csv").write_text("T_C,f_Hz,F0 (N),z0 (µm),psi (deg)\n" + tests, encoding="utf-8")
    return [Path("p.csv")]


def test_peaks_need_a_geometry_and_set_the_amplitude():
    refused(new_study, "mine", peaks(), StudyOptions(), names=["--geometry b_mm=25,B_mm=56,e_mm=25,h_mm=250"])
    refused(new_study, "mine", peaks(), StudyOptions(measured_in=DIRECT), names=["direct test"])
    geometry = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
    study = accepted(new_study("mine", peaks(), StudyOptions(geometry=geometry))[0])
    assert study["test"]["amplitude_m"] == pytest.approx(50e-6)  # the median
    assert study["test"]["time_step_s"] == 8e-5  # a five-hundredth of 25 Hz
    assert "E_MPa" not in read_csv("data/mine/measurements.csv").columns


def test_a_frequency_so_low_that_no_test_takes_as_many_steps_gets_steps_by_the_cycle():
    rows = [f"A,{t},{f},{9000 - 100 * t + 100 * f},20" for t in (10, 20) for f in (0.01, 1, 25)]
    Path("slow.csv").write_text("\n".join(["specimen,T_C,f_Hz,E_MPa,phase_deg", *rows]) + "\n")
    test = accepted(new_study("slow", [Path("slow.csv")], StudyOptions(measured_in="bending"))[0])["test"]
    assert test["steps_per_cycle"] == 200


def test_replicates_become_specimens_and_readings_isotherms():
    rows = [
        f"A,{k},{t + 0.2 * k},{f},{9000 - 100 * t + 100 * f},20"
        for k in (1, 2)
        for t in (5, 15)
        for f in (1, 10)
    ]
    Path("m.csv").write_text("\n".join(["specimen,replicate,T_C,f_Hz,E (MPa),phi (deg)", *rows]) + "\n")
    study = accepted(new_study("mine", [Path("m.csv")], StudyOptions())[0])
    table = read_csv("data/mine/measurements.csv")
    assert table.columns["specimen"] == ["A-1"] * 4 + ["A-2"] * 4
    assert study["temperatures_C"] == [5.3, 15.3]
    assert table.numbers("temperature_C").tolist() == [5.3, 5.3, 15.3, 15.3] * 2


def test_moduli_without_phases_are_no_study():
    Path("m.csv").write_text(
        "T_C,f_Hz,E (MPa)\n15,10,9000\n15,25,9500\n20,10,8000\n20,25,8600\n", encoding="utf-8"
    )
    refused(new_study, "mine", [Path("m.csv")], StudyOptions(), names=["m.csv", "phase_deg", "diagnose"])


def test_tests_outside_the_full_grid_are_left_out_and_said():
    tests = [*rows(), *rows(temperatures=[20], frequencies=[10, 3])]
    config, notes = new_study("mine", german(tests), StudyOptions())
    study = accepted(config)
    assert (study["temperatures_C"], study["frequencies_Hz"]) == ([10, 15], [1, 10])
    assert any(note.startswith("4 of 12 tests") for note in notes)


@pytest.mark.parametrize(
    ("tests", "names"),
    [
        (rows(frequencies=[10, 10.1]), ["10 and 10.1 Hz"]),
        (rows(frequencies=[10]), ["10 degC"]),
        ([(1, 15, 1, 9000.0, 0.3), (1, 15, 10, 9500.0, 0.3)], ["MPa"]),
        ([(1, 15, 1, 0.009, 0.3), (1, 15, 10, 0.0095, 0.3)], ["softer"]),
        ([(1, 15, 1, 9.0, 20), (1, 15, 10, 9.5, 20)], ["line 2", "20 rad", "1146 deg"]),
    ],
)
def test_what_cannot_be_meant_is_refused_and_leaves_nothing(folder, tests, names):
    refused(made, tests=tests, names=["t.csv", *names])
    assert [path.name for path in folder.iterdir()] == ["t.csv"]


BAD_NAMES = [
    "../mine",
    "1st",
    "my study",
    "",
    "published",
    "verification",
    "mine\n",
    "null",
    "on",
    "con",
    "Lpt1",
]


@pytest.mark.parametrize("name", BAD_NAMES)
def test_bad_names(name):
    with pytest.raises(InputError, match="NAME"):
        made(name)


def test_nothing_is_replaced():
    made()
    refused(made, names=["config/mine.yaml"])
    Path("data/paper").mkdir()
    refused(made, "paper", names=["data/paper"])


def test_refused_study_leaves_nothing(folder, monkeypatch):
    def refuse(*_):
        raise InputError("no")

    monkeypatch.setattr("asphalt_nscd.table_import.write.require_feasible", refuse)
    refused(made, names=["no"])
    assert not (folder / "data/mine").exists()
    assert not (folder / "config").exists()


def test_file_names_cannot_write_into_the_configuration():
    evil = Path("a\nstudy: evil #.csv")
    german(rows())[0].rename(evil)
    assert accepted(new_study("mine", [evil], StudyOptions())[0])["study"] == "mine"
