"""`new-study` from table to a configuration that the workflow accepts."""

from __future__ import annotations

import math
from pathlib import Path

import openpyxl
import pandas as pd
import pytest
import yaml

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.study.configuration import complete_study
from asphalt_nscd.study.preflight import require_feasible
from asphalt_nscd.table_import.duration import duration
from asphalt_nscd.table_import.write import SCHEMA, StudyOptions, new_study

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
PRISM = {"b_mm": 50, "B_mm": 50, "e_mm": 50, "h_mm": 300, "mass_kg": 1.8, "mobile_mass_kg": 0.2}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rows(temperatures=(10, 15), frequencies=(1, 10), specimens=(1, 2)):
    for specimen in specimens:
        for temperature in temperatures:
            for frequency in frequencies:
                modulus = complex(LAW.complex_modulus(2 * math.pi * frequency))
                yield (
                    specimen,
                    temperature,
                    frequency,
                    abs(modulus) * 1e-9,
                    math.atan2(modulus.imag, modulus.real),
                )


def german(tests):
    lines = [f"{s};{t};{f};{e:.4f};{p:.5f}".replace(".", ",") for s, t, f, e, p in tests]
    Path("t.csv").write_text(
        "\n".join(["Sample;Temp °C;f (Hz);|E*| [GPa];delta_rad", *lines]) + "\n", encoding="utf-8"
    )
    return [Path("t.csv")]


def accepted(config):
    study = complete_study(yaml.safe_load(config.read_text(encoding="utf-8")), str(config), SCHEMA)
    require_feasible(study, str(config))
    return study


def test_german_table_becomes_a_full_size_study():
    config, notes = new_study("mine", german(rows()), StudyOptions())
    study = accepted(config)
    assert "E_MPa from column '|E*| [GPa]', converted from GPa" in notes
    assert (study["temperatures_C"], study["frequencies_Hz"]) == ([10, 15], [1, 10])
    assert study["specimens"]["seeds"] == [1, 2, 3, 4] and study["specimens"]["bonds"]["area"] == "facets"
    assert read_csv(study["specimens"]["counts_table"]).columns["count"] == [
        "11798",
        "1588",
        "492",
        "211",
        "71",
    ]
    table = read_csv("data/mine/measurements.csv")
    expected = [1e3 * modulus for *_, modulus, _ in rows()]
    assert table.numbers("E_MPa").tolist() == pytest.approx(expected, rel=1e-4)
    assert table.numbers("phase_deg")[0] == pytest.approx(math.degrees(next(rows())[4]), rel=1e-4)


def test_workbook_becomes_the_same_table():
    new_study("csv", german(rows()), StudyOptions())
    book = openpyxl.Workbook()
    book.active.append(["Sample", "Temp °C", "f (Hz)", "|E*| [GPa]", "delta_rad"])
    for s, t, f, e, p in rows():
        book.active.append([s, t, f, round(e, 4), round(p, 5)])
    book.save("t.xlsx")
    new_study("xlsx", [Path("t.xlsx")], StudyOptions())
    assert Path("data/csv/measurements.csv").read_bytes() == Path("data/xlsx/measurements.csv").read_bytes()


def test_small_study_keeps_the_measured_geometry_beside_the_simulated_one():
    study = accepted(new_study("mine", german(rows()), StudyOptions(geometry=PRISM, small=True))[0])
    assert study["geometry"] == PRISM
    assert study["specimens"]["geometry"]["h_mm"] == 60
    assert study["specimens"]["seeds"] == [1]


def test_a_table_too_short_for_a_diagnosis_is_refused_at_once():
    Path("two.csv").write_text(
        "specimen,T (°C),f (Hz),E (MPa),phi (deg)\na,15,10,5000,20\na,15,25,6000,18\n", encoding="utf-8"
    )
    with pytest.raises(
        InputError,
        match="two.csv: 2 tests at 2 frequencies are too few for a diagnosis",
    ):
        new_study("mine", [Path("two.csv")], StudyOptions())
    assert not Path("data/mine").exists()


def test_prism_is_simulated_as_a_prism():
    study = accepted(new_study("mine", german(rows()), StudyOptions(geometry=PRISM))[0])
    assert study["specimens"]["geometry"] == PRISM
    assert study["specimens"]["box_m"][:2] == [0.3, 0.05]


def test_direct_tests_are_said_to_be_taken_as_measured():
    config, _ = new_study("mine", german(rows()), StudyOptions(measured_in="tension-compression"))
    assert "Moduli are taken as they were measured, in direct tension-compression," in config.read_text()
    assert accepted(config)["diagnosis"]["measured_in"] == "tension-compression"


def test_direct_tests_are_simulated_on_a_cylinder():
    ampt = accepted(new_study("ampt", german(rows()), StudyOptions(measured_in="tension-compression"))[0])
    assert ampt["specimens"]["geometry"] == {"d_mm": 100, "h_mm": 150, "mass_kg": 2.83, "mobile_mass_kg": 0}
    assert ampt["test"]["amplitude_m"] == pytest.approx(50e-6 * 0.15)
    assert ampt["test"]["type"] == "tension-compression" and ampt["test"]["steps_per_cycle"] == 200
    counts = pd.read_csv(ampt["specimens"]["counts_table"])
    assert (
        counts["diameter_mm"].tolist() == [4.0, 8.0, 12.6, 16.0, 20.0] and 7000 < counts["count"].sum() < 8000
    )
    given = {"d_mm": 60.0, "h_mm": 120.0, "mass_kg": 0.8, "mobile_mass_kg": 0.1}
    other = StudyOptions(measured_in="tension-compression", geometry=given)
    assert accepted(new_study("other", german(rows()), other)[0])["specimens"]["geometry"] == given
    small = StudyOptions(measured_in="tension-compression", small=True)
    assert accepted(new_study("small", german(rows()), small)[0])["specimens"]["geometry"]["d_mm"] == 18
    with pytest.raises(
        InputError, match="of a cylinder is for tests in tension-compression; say --measured-in"
    ):
        new_study("bent", german(rows()), StudyOptions(geometry=given))


def peaks():
    Path("p.csv").write_text(
        "T_C,f_Hz,F0 (N),z0 (µm),psi (deg)\n15,10,60,50,20\n15,25,65,50,18\n20,10,50,50,25\n20,25,55,50,22\n",
        encoding="utf-8",
    )
    return [Path("p.csv")]


def test_peaks_need_a_geometry_and_set_the_amplitude():
    with pytest.raises(
        InputError, match="give it, the paper's as --geometry b_mm=25,B_mm=56,e_mm=25,h_mm=250"
    ):
        new_study("mine", peaks(), StudyOptions())
    with pytest.raises(InputError, match="of a direct test are not reduced here"):
        new_study("mine", peaks(), StudyOptions(measured_in="tension-compression"))
    geometry = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
    study = accepted(new_study("mine", peaks(), StudyOptions(geometry=geometry))[0])
    assert study["test"]["amplitude_m"] == pytest.approx(50e-6)
    assert "E_MPa" not in read_csv("data/mine/measurements.csv").columns


def test_tests_outside_the_full_grid_are_left_out_and_said():
    tests = [*rows(), *rows(temperatures=[20], frequencies=[10, 3])]
    config, notes = new_study("mine", german(tests), StudyOptions())
    study = accepted(config)
    assert (study["temperatures_C"], study["frequencies_Hz"]) == ([10, 15], [1, 10])
    assert any(note.startswith("4 of 12 tests are not simulated") for note in notes)


@pytest.mark.parametrize(
    ("tests", "sentence"),
    [
        (rows(temperatures=[15, 15.1]), "temperatures 15 and 15.1 degC are probably one set value"),
        (rows(frequencies=[10, 10.1]), "frequencies 10 and 10.1 Hz are probably one"),
        (rows(frequencies=[10]), "only one frequency at 10 degC"),
        ([(1, 15, 1, 9000.0, 0.3), (1, 15, 10, 9500.0, 0.3)], "read as MPa it fits: is the unit MPa?"),
        ([(1, 15, 1, 0.009, 0.3), (1, 15, 10, 0.0095, 0.3)], "softer than any asphalt"),
        (
            [(1, 15, 1, 9.0, 20), (1, 15, 10, 9.5, 20)],
            "line 2: a phase of 20,00000 rad is 1146 deg, more than any material has",
        ),
    ],
)
def test_what_cannot_be_meant_is_refused_and_leaves_nothing(folder, tests, sentence):
    with pytest.raises(InputError) as error:
        new_study("mine", german(tests), StudyOptions())
    assert sentence in str(error.value) and str(error.value).startswith("t.csv")
    assert [path.name for path in folder.iterdir()] == ["t.csv"]


@pytest.mark.parametrize(
    "name", ["../mine", "1st", "my study", "", "published", "verification", "mine\n", "null", "on"]
)
def test_bad_names(name):
    with pytest.raises(InputError, match="NAME"):
        new_study(name, german(rows()), StudyOptions())


def test_nothing_is_replaced():
    new_study("mine", german(rows()), StudyOptions())
    with pytest.raises(InputError, match=r"config/mine\.yaml exists already; choose another NAME"):
        new_study("mine", german(rows()), StudyOptions())
    Path("data/paper").mkdir()
    with pytest.raises(InputError, match="data/paper exists already"):
        new_study("paper", german(rows()), StudyOptions())


def test_refused_study_leaves_nothing(folder, monkeypatch):
    def refuse(*_):
        raise InputError("no")

    monkeypatch.setattr("asphalt_nscd.table_import.write.require_feasible", refuse)
    with pytest.raises(InputError, match="no"):
        new_study("mine", german(rows()), StudyOptions())
    assert not (folder / "data/mine").exists() and not (folder / "config").exists()


def test_file_names_cannot_write_into_the_configuration():
    evil = Path("a\nstudy: evil #.csv")
    german(rows())[0].rename(evil)
    assert accepted(new_study("mine", [evil], StudyOptions())[0])["study"] == "mine"


def test_duration_grows_with_slow_tests_and_is_the_paper_studys_for_the_paper():
    assert duration(14160, 4, 6, [3, 6, 10, 25, 40], 5e-5) in {f"about {n} minutes" for n in range(12, 31)}
    assert duration(14160, 4, 6, [0.001, 40], 5e-5).endswith("hours")


def test_an_installed_package_has_no_studies(monkeypatch):
    monkeypatch.setattr("asphalt_nscd.table_import.write.SCHEMA", Path("nowhere/study.schema.yaml"))
    with pytest.raises(InputError, match="a study runs in a clone of the repository"):
        new_study("mine", german(rows()), StudyOptions())
