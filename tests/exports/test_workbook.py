"""The workbook, held against the law and the diagnosis."""

from __future__ import annotations

import re
from datetime import datetime
from zipfile import ZipFile

import numpy as np
import openpyxl
import pandas as pd
import pytest
from naive.prony import SPECTRA, assert_within

from asphalt_nscd.exports.export import export_law
from asphalt_nscd.exports.formats.xlsx import write_sheets
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
    np.testing.assert_allclose(curve["|E*| of the law [MPa]"] * 1e6, np.abs(wanted), rtol=1e-9)
    prony = sheets["Prony series"]
    turned = 2j * np.pi * frequency[:, None] * prony["relaxation time [s]"].to_numpy()[1:]
    moduli = 1e6 * prony["modulus [MPa]"].to_numpy()
    found = moduli[0] + (moduli[1:] * turned / (1 + turned)).sum(axis=1)
    assert_within(found, wanted, "\n".join(sheets["Read me"].iloc[:, 0]), Miss(1.0, 0.5))
    np.testing.assert_allclose(curve["phase of the Prony series [°]"], np.degrees(np.angle(found)), rtol=1e-6)
    measured = sheets["Measured"]
    np.testing.assert_allclose(measured["ln(measured |E*| / law) [%]"], 100 * np.log(1.02), rtol=1e-6)
    np.testing.assert_allclose(measured["measured phase - law [°]"], 0.3, rtol=1e-6)
    shift = sheets["Shift factors"].set_index("temperature [°C]")["log10 a_T [decades]"]
    assert shift[21.0] == 0.0 and shift[-10.0] == pytest.approx(np.log10(law.shift.factor(-10.0)))


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
