"""The workbook, held against the law and the diagnosis."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import datetime
from types import SimpleNamespace
from zipfile import ZipFile

import numpy as np
import openpyxl
import pandas as pd
import pytest
from naive.prony import SPECTRA, assert_within

from asphalt_nscd.exports.card import make_card
from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.formats import xlsx
from asphalt_nscd.exports.formats.xlsx import _law, _master_curve, write_sheets
from asphalt_nscd.exports.law import read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.store import write_json
from asphalt_nscd.rheology.maxwell_fitting import Miss


def test_the_workbook_comes_back(folder):
    law = SPECTRA["FD"][0]
    export_law(
        read_law_file(folder / "law.json"), ExportSettings(units="mm-N-MPa"), "xlsx", folder / "law.xlsx"
    )
    sheets = pd.read_excel(folder / "law.xlsx", sheet_name=None)
    names = ["Read me", "Law", "Shift factors", "Master curve", "Prony series", "Measured", "Residuals"]
    assert list(sheets) == names
    headings = [heading for name in names[2:] for heading in sheets[name].columns]
    without_unit = {heading for heading in headings if not re.search(r"\[.+\]$", heading)}
    assert all(heading.startswith(("specimen", "branch", "tested")) for heading in without_unit)
    curve = sheets["Master curve"]
    frequency = curve["frequency at 21 °C [Hz]"].to_numpy()
    wanted = law.complex_modulus(2 * np.pi * frequency, 21.0)
    low, high = 2 * np.pi * np.array([0.1, 25.0]) * law.shift.factor(np.array([54.0, -10.0]))
    assert (frequency[0], frequency[-1]) == pytest.approx((low / (2 * np.pi), high / (2 * np.pi)))
    assert np.diff(np.log10(frequency)) == pytest.approx(1 / 8, rel=0.03)  # eight in a decade
    told = {
        "|E*| of the law [MPa]": np.abs(wanted) / 1e6,
        "phase of the law [°]": np.degrees(np.angle(wanted)),
        "E' of the law [MPa]": wanted.real / 1e6,
        "E'' of the law [MPa]": wanted.imag / 1e6,
    }
    for name, values in told.items():
        np.testing.assert_allclose(curve[name], values, rtol=1e-9, err_msg=name)
    prony = sheets["Prony series"]
    turned = 2j * np.pi * frequency[:, None] * prony["relaxation time [s]"].to_numpy()[1:]
    moduli = 1e6 * prony["modulus [MPa]"].to_numpy()
    found = moduli[0] + (moduli[1:] * turned / (1 + turned)).sum(axis=1)
    assert_within(found, wanted, "\n".join(sheets["Read me"].iloc[:, 0]), Miss(1.0, 0.5))
    np.testing.assert_allclose(curve["phase of the Prony series [°]"], np.degrees(np.angle(found)), rtol=1e-6)
    np.testing.assert_allclose(curve["|E*| of the Prony series [MPa]"], np.abs(found) / 1e6, rtol=1e-6)
    np.testing.assert_allclose(
        prony["share of the instantaneous modulus [1]"], moduli / moduli.sum(), rtol=1e-6
    )
    measured, tests = sheets["Measured"], pd.read_csv(folder / "residuals.csv")
    own = law.complex_modulus(2 * np.pi * tests["frequency_Hz"].to_numpy(), tests["temperature_C"].to_numpy())
    told = {
        "frequency at 21 °C [Hz]": tests["frequency_Hz"]
        * law.shift.factor(tests["temperature_C"].to_numpy()),
        "measured |E*| [MPa]": tests["E_MPa"],
        "measured phase [°]": tests["phase_deg"],
        "|E*| of the law [MPa]": np.abs(own) / 1e6,
        "phase of the law [°]": np.degrees(np.angle(own)),
        "ln(measured |E*| / law) [%]": np.full(len(tests), 100 * np.log(1.02)),
        "measured phase - law [°]": np.full(len(tests), 0.3),
    }
    for name, values in told.items():
        np.testing.assert_allclose(measured[name], values, rtol=1e-6, err_msg=name)
    shift = sheets["Shift factors"].set_index("temperature [°C]")
    tested = sorted({*tests["temperature_C"]})
    assert sorted({*shift.index} - {*tested}) == [
        -5.0,
        0.0,
        5.0,
        10.0,
        15.0,
        20.0,
        25.0,
        30.0,
        35.0,
        40.0,
        45.0,
        50.0,
    ]
    assert shift.index[shift["tested"] == "yes"].tolist() == tested
    np.testing.assert_allclose(
        shift["a_T from 21 °C [1]"], law.shift.factor(shift.index.to_numpy()), rtol=1e-9
    )
    np.testing.assert_allclose(10 ** shift["log10 a_T [decades]"], shift["a_T from 21 °C [1]"], rtol=1e-9)
    stated = sheets["Law"].set_index(sheets["Law"].columns[0])["value"]
    assert stated["E_glassy_Pa"] == law.glassy_modulus and stated["wlf_C1"] == law.shift.c1
    assert stated["law"].startswith("2S2P1D") and stated["source"] == "fitted (synthetic)"


def test_intervals_stand_about_the_law(folder):
    """Half widths of 10 % and 0.02 rad everywhere, and a parameter with its error and interval."""
    read = read_law_file(folder / "law.json")
    sure = SimpleNamespace(half=lambda law, omega, temperature: np.full(omega.shape, np.log(1.1) + 0.02j))
    law = replace(
        read, uncertainty=sure, std_error={"E_glassy_Pa": 2e8}, intervals={"E_glassy_Pa": (1e10, 4e10)}
    )
    card = replace(make_card(read, ExportSettings()), law=law)
    curve = _master_curve(card)
    size, phase = curve["|E*| of the law [MPa]"], curve["phase of the law [°]"]
    for quantity, unit, ends in (("|E*|", "MPa", (size / 1.1, size * 1.1)), ("phase", "°", None)):
        ends = ends or (phase - np.degrees(0.02), phase + np.degrees(0.02))
        for word, values in zip(("from", "to"), ends, strict=True):
            np.testing.assert_allclose(curve[f"{quantity}, 95 % {word} [{unit}]"], values)
    rows = {row[0]: row[1:] for row in _law(card).itertuples(index=False, name=None)}
    assert rows["E_glassy_Pa"][1:] == (2e8, 1e10, 4e10)


def test_the_workbook_of_a_diagnosis_parts_what_was_left_out(tmp_path, monkeypatch):
    tests = {
        "specimen": ["01", "02"],
        "status": ["used", "left out"],
        "E_MPa": [1.5, 2.5],
        "phase_deg": [3, 4],
    }
    pd.DataFrame(tests | {"corrected_for": ["delay", "delay"]}).to_csv(
        tmp_path / "corrected.csv", index=False
    )
    for name in ("reported", "master_curve"):
        pd.DataFrame({name: [1.0]}).to_csv(tmp_path / f"{name}.csv", index=False)
    parameters = {
        "tau_s": {"value": 0.5, "interval_95": [0.25, 0.75], "determined": True},
        "beta": {"value": 9.0, "interval_95": None, "determined": False},
    }
    content = {"law_parameters": parameters, "laws": [{"title": "2S2P1D", "parameters": 9}]}
    monkeypatch.setattr(xlsx, "read_diagnosis", lambda paths: content)
    sheets = pd.read_excel(xlsx.corrected_workbook(tmp_path), sheet_name=None, dtype={"specimen": str})
    assert list(sheets) == ["Corrected", "Left out", "Mix", "Master curve", "Law", "Laws compared"]
    assert sheets["Corrected"].values.tolist() == [["01", "used", 1.5, 3, "delay"]]
    assert sheets["Left out"].values.tolist() == [["02", "left out"]]
    assert sheets["Law"].iloc[0].tolist() == ["tau_s", 0.5, 0.25, 0.75, "yes"]
    assert sheets["Law"].iloc[1].dropna().tolist() == ["beta", 9.0, "no"]


@pytest.mark.parametrize(
    ("value", "form"),
    [
        (3.0, "General"), (0.25, "General"), (1e5, "0.0000E+00"), (0.001, "0.0000E+00"), (0.0123456, "0.0000"),
        (1.23456, "0.0000"), (12.3456, "0.000"), (123.456, "0.00"), (-1234.567, "0.0"), (12345.678, "0"),
    ],
)  # fmt: skip
def test_five_digits_of_a_number_are_shown(value, form):
    assert xlsx._shown(value) == form


def test_a_key_of_the_diagnosis_becomes_a_heading():
    names = ["temperature_C", "phase_deg", "off_by_percent", "decided_by"]
    assert [*map(xlsx._heading, names)] == ["temperature [°C]", "phase [°]", "off by [percent]", "decided by"]


def test_no_time_of_day_is_written(folder):
    export_law(read_law_file(folder / "law.json"), ExportSettings(), "xlsx", folder / "law.xlsx")
    with ZipFile(folder / "law.xlsx") as parts:
        assert {part.date_time for part in parts.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    properties = openpyxl.load_workbook(folder / "law.xlsx").properties
    assert properties.created == properties.modified == datetime(1980, 1, 1)


def test_suspect_tests_and_notes_of_a_diagnosis_stand_in_the_workbook(folder, monkeypatch):
    content = {
        "suspect_tests": [{"specimen": "=1+1", "temperature_C": 37.0, "frequency_Hz": 25.0, "z": 6.1}],
        "unexplained": [],
        "notes": ["Look at the clamp."],
    }
    write_json(folder / "diagnosis.json", content)
    monkeypatch.setattr("asphalt_nscd.exports.formats.xlsx.read_diagnosis", lambda paths: content)
    export_law(read_law_file(folder / "law.json"), ExportSettings(), "xlsx", folder / "law.xlsx")
    book = openpyxl.load_workbook(folder / "law.xlsx")
    assert [cell.value for cell in book["Suspects"][2]] == ["=1+1", 37, 25, 6.1]
    assert book["Suspects"]["A2"].data_type == "s"  # no formula
    assert book["Notes"]["A2"].value == "Look at the clamp."
    assert "Unexplained" not in book.sheetnames


def test_a_long_last_column_leaves_the_first_as_it_is(tmp_path):
    sheets = {
        "Suspects": pd.DataFrame({"specimen": ["1"], "reasons": ["word " * 60]}),
        "Notes": pd.DataFrame({"n": ["word " * 60]}),
    }
    write_sheets(tmp_path / "t.xlsx", sheets)
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    assert not book["Suspects"]["A2"].alignment.wrap_text and book["Notes"]["A2"].alignment.wrap_text


def test_numbers_are_shown_short_and_a_sheet_prints_on_a_page(tmp_path):
    write_sheets(
        tmp_path / "t.xlsx",
        {"Curves": pd.DataFrame({"frequency_Hz": [1e5, np.inf], "E_MPa": [1234.56789, np.nan]})},
    )
    sheet = openpyxl.load_workbook(tmp_path / "t.xlsx")["Curves"]
    assert sheet["B2"].value == 1234.56789 and sheet["B2"].number_format == "0.0"
    assert sheet["A3"].value is sheet["B3"].value is None  # no spreadsheet has a number for these
    assert all(sheet.column_dimensions[letter].width >= 11 for letter in "AB")  # no ### for 8.5604E+07
    assert (sheet.sheet_properties.pageSetUpPr.fitToPage, sheet.page_setup.fitToWidth) == (True, 1)
