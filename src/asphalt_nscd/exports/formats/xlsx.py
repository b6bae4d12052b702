"""A workbook: law, shift factors, master curve, Prony series, and of a diagnosis tests, residuals, suspects."""

from __future__ import annotations

import re
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
import pandas as pd
from openpyxl import Workbook
from openpyxl.styles import Alignment, Font
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from asphalt_nscd.diagnosis.content.doubts import LEFT_OUT
from asphalt_nscd.diagnosis.written import read_diagnosis, read_residuals
from asphalt_nscd.exports.card import Card, make_card
from asphalt_nscd.exports.formats import csv
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.paths import is_file
from asphalt_nscd.files.store import atomic_path

ENDINGS = (".xlsx",)
IN_A_DECADE = 8  # frequencies of the master curve
STEP = 5.0  # K, of the shift factors
WIDEST = 90  # characters of a column
NUMBER = 10  # characters of the longest number that is shown, -1.2345E-03
COLUMNS_UPRIGHT = 6  # more are printed on a page laid across
DATE = b"1980-01-01T00:00:00Z"  # where the dates of zip archives begin

HEADINGS = {
    "specimen": "specimen",
    "temperature_C": "temperature [°C]",
    "frequency_Hz": "frequency [Hz]",
    "E_MPa": "measured |E*| [MPa]",
    "phase_deg": "measured phase [°]",
    "E_before_MPa": "|E*| of the Burgers laws [MPa]",
    "phase_before_deg": "phase of the Burgers laws [°]",
    "residual_E_before_percent": "ln(measured |E*| / Burgers laws) [%]",
    "residual_phase_before_deg": "measured phase - Burgers laws [°]",
    "residual_E_percent": "ln(measured |E*| / named causes) [%]",
    "residual_phase_deg": "measured phase - named causes [°]",
    "z": "residual over its scatter [1]",
    "E_after_MPa": "|E*| with the named causes [MPa]",
    "phase_after_deg": "phase with the named causes [°]",
    "residual_E_after_percent": "ln(measured |E*| / named causes) [%]",
    "residual_phase_after_deg": "measured phase - named causes [°]",
}


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the workbook of a law, with what stands beside it in the folder of a diagnosis; a line on it."""
    card = make_card(law, settings)
    book = Workbook()
    # openpyxl begins with an empty sheet of its own.
    book.remove(book.worksheets[0])
    _fill(book, "Read me", pd.DataFrame({"what this is": card.statements()}))
    _fill(book, "Law", _law(card))
    if card.law.shift is not None:
        _fill(book, "Shift factors", _shift_factors(card))
    _fill(book, "Master curve" if card.law.shift is not None else "Complex modulus", _master_curve(card))
    _fill(book, "Prony series", _prony(card))
    folder = card.law.path.parent
    if card.law.shift is not None and is_file(folder / "residuals.csv"):
        tests = read_residuals([folder / "residuals.csv"])
        _fill(book, "Measured", _measured(card, tests))
        _fill(book, "Residuals", tests.rename(columns=HEADINGS))
        if is_file(folder / "diagnosis.json"):
            _diagnosis(book, read_diagnosis([folder / "diagnosis.json"]))
    _save(book, path)
    return card.told()


def write_sheets(path: Path, sheets: Mapping[str, pd.DataFrame]) -> None:
    """Write tables, by the names of their sheets, into one workbook, equal whenever it is written."""
    book = Workbook()
    book.remove(book.worksheets[0])
    for title, frame in sheets.items():
        _fill(book, title, frame)
    with atomic_path(path) as temporary:
        _save(book, temporary)


def corrected_workbook(folder: Path) -> Path:
    """Write corrected.xlsx from what a diagnosis left in a folder: tests, what was left out, the mix, its law."""
    # A specimen called 01 is not 1.
    tests = pd.read_csv(folder / "corrected.csv", dtype={"specimen": str})
    out = tests["status"] == LEFT_OUT
    sheets = {
        "Corrected": tests[~out],
        "Left out": tests[out].drop(columns=["E_MPa", "phase_deg", "corrected_for"]),
        "Mix": pd.read_csv(folder / "reported.csv"),
        "Master curve": pd.read_csv(folder / "master_curve.csv"),
    }
    content = read_diagnosis([folder / "diagnosis.json"])
    if content["law_parameters"]:
        sheets["Law"] = pd.DataFrame(
            [
                (
                    name,
                    one["value"],
                    *(one["interval_95"] or (None, None)),
                    "yes" if one["determined"] else "no",
                )
                for name, one in content["law_parameters"].items()
            ],
            columns=["parameter of law.json", "value", "95 % from", "95 % to", "determined by these tests"],
        )
        sheets["Laws compared"] = pd.DataFrame(content["laws"])
    filled = {name: table for name, table in sheets.items() if len(table)}
    write_sheets(folder / "corrected.xlsx", filled)
    return folder / "corrected.xlsx"


def _law(card: Card) -> pd.DataFrame:
    """Parameters under the keys of the law file, which carry the units."""
    law = card.law
    rows = [
        (name, value, law.std_error.get(name), *law.intervals.get(name, (None, None)))
        for name, value in law.parameters.items()
    ]
    return pd.DataFrame(
        [("law", law.name, *[None] * 3), ("source", law.source, *[None] * 3), *rows],
        columns=["parameter, unit at the end of its name", "value", "standard error", "95 % from", "95 % to"],
    )


def _shift_factors(card: Card) -> pd.DataFrame:
    tested = np.unique(card.law.band.temperature)
    even = np.arange(STEP * np.ceil(tested.min() / STEP), tested.max() + 1e-9, STEP)
    temperature = np.unique(np.concatenate([tested, even, [card.law.temperature]]))
    factor = card.law.factor(temperature)
    return pd.DataFrame(
        {
            "temperature [°C]": temperature,
            f"a_T from {card.law.temperature:g} °C [1]": factor,
            "log10 a_T [decades]": np.log10(factor),
            "tested": np.where(np.isin(temperature, tested), "yes", ""),
        }
    )


def _master_curve(card: Card) -> pd.DataFrame:
    """The law and its Prony series over the tested band, at frequencies reduced to one temperature."""
    low, high = card.law.reduced_band()
    omega = np.geomspace(low, high, max(3, round(IN_A_DECADE * np.log10(high / low)) + 1))
    law, series = card.law.reference_modulus(omega), card.series.complex_modulus(omega)
    half = card.law.half_widths(omega)
    modulus, phase = np.abs(law) / 1e6, np.degrees(np.angle(law))
    band = {}
    if half is not None:
        by, off = np.exp(half.real), np.degrees(half.imag)
        band = {
            "|E*|, 95 % from [MPa]": modulus / by,
            "|E*|, 95 % to [MPa]": modulus * by,
            "phase, 95 % from [°]": phase - off,
            "phase, 95 % to [°]": phase + off,
        }
    return pd.DataFrame(
        {
            f"frequency at {card.law.temperature:g} °C [Hz]": omega / (2.0 * np.pi),
            "|E*| of the law [MPa]": modulus,
            "phase of the law [°]": phase,
            **band,
            "E' of the law [MPa]": law.real / 1e6,
            "E'' of the law [MPa]": law.imag / 1e6,
            "|E*| of the Prony series [MPa]": np.abs(series) / 1e6,
            "phase of the Prony series [°]": np.degrees(np.angle(series)),
        }
    )


def _prony(card: Card) -> pd.DataFrame:
    """The series as the CSV has it; `_fill` leaves the infinite time of the long-term modulus empty."""
    unit = card.units.stress
    return csv.frame(card).rename(
        columns={
            "branch": "branch (0: long-term modulus)",
            f"modulus_{unit}": f"modulus [{unit}]",
            f"half_95_{unit}": f"half of its 95 % interval [{unit}]",
            "relaxation_time_s": "relaxation time [s]",
            "share_of_instantaneous": "share of the instantaneous modulus [1]",
        }
    )


def _measured(card: Card, tests: pd.DataFrame) -> pd.DataFrame:
    """Each test beside the law of this file."""
    factor = card.law.factor(tests["temperature_C"].to_numpy(float))
    reduced = tests["frequency_Hz"].to_numpy(float) * factor
    law = card.law.reference_modulus(2.0 * np.pi * reduced)
    modulus, phase = np.abs(law) / 1e6, np.degrees(np.angle(law))
    own = tests[["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]]
    return own.rename(columns=HEADINGS).assign(
        **{
            f"frequency at {card.law.temperature:g} °C [Hz]": reduced,
            "|E*| of the law [MPa]": modulus,
            "phase of the law [°]": phase,
            "ln(measured |E*| / law) [%]": 100.0 * np.log(own["E_MPa"] / modulus),
            "measured phase - law [°]": own["phase_deg"] - phase,
        }
    )


def _diagnosis(book: Workbook, content: Mapping[str, Any]) -> None:
    """Suspect tests and unexplained conditions, where the diagnosis has any, and its notes."""
    for key, title in (("suspect_tests", "Suspects"), ("unexplained", "Unexplained")):
        if content.get(key):
            frame = pd.json_normalize(content[key])
            if "reasons" in frame:
                frame["reasons"] = frame["reasons"].str.join("; ")
            _fill(book, title, frame.rename(columns=_heading))
    if content.get("notes"):
        _fill(book, "Notes", pd.DataFrame({"note of the diagnosis": content["notes"]}))


def _save(book: Workbook, path: Path) -> None:
    """Write a workbook without the time of day, which openpyxl puts into it and into its archive."""
    made = BytesIO()
    book.save(made)
    with ZipFile(made) as timed, ZipFile(path, "w", ZIP_DEFLATED) as timeless:
        for name in timed.namelist():
            part = timed.read(name)
            if name == "docProps/core.xml":
                part = re.sub(rb"(<dcterms:(created|modified)[^>]*>)[^<]*", rb"\g<1>" + DATE, part)
            # A new entry is dated 1980; the one that was read has the time of day.
            timeless.writestr(ZipInfo(name), part, ZIP_DEFLATED)


def _heading(name: str) -> str:
    """A key of the diagnosis as a heading: residual_E_percent -> residual E [percent]."""
    if name in HEADINGS:
        return HEADINGS[name].removeprefix("measured ")
    stem, _, unit = name.rpartition("_")
    known = unit in ("percent", "deg", "MPa", "Hz", "C", "s")
    return f"{stem.replace('_', ' ')} [{unit}]" if known else name.replace("_", " ")


def _fill(book: Workbook, title: str, frame: pd.DataFrame) -> None:
    """Add a sheet with the frame, and its headings on top, which stay in sight."""
    sheet: Worksheet = book.create_sheet(title)
    sheet.append(list(frame.columns))
    for row in frame.astype(object).itertuples(index=False):
        sheet.append([_cell(value) for value in row])
    for cells in sheet.iter_rows():
        for cell in cells:
            if isinstance(cell.value, str):
                cell.data_type = "s"  # text that begins with = is no formula
            elif isinstance(cell.value, float):
                cell.number_format = _shown(cell.value)
    for number, name in enumerate(frame.columns, start=1):
        longest = max([NUMBER, len(str(name)), *(len(v) for v in frame[name] if isinstance(v, str))])
        sheet.column_dimensions[get_column_letter(number)].width = min(longest + 2, WIDEST)
    for cell in sheet[1]:
        cell.font, cell.alignment = Font(bold=True), Alignment(wrap_text=True, vertical="top")
    if len(frame.columns) == 1 and longest > WIDEST:  # a sheet of sentences
        for (cell,) in sheet.iter_rows(min_row=2, max_col=1):
            cell.alignment = Alignment(wrap_text=True, vertical="top")
    sheet.freeze_panes = "A2"
    _fit_to_page(sheet, landscape=len(frame.columns) > COLUMNS_UPRIGHT)


def _fit_to_page(sheet: Worksheet, landscape: bool) -> None:
    """Print all columns within the width of an A4 page."""
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    sheet.page_setup.paperSize = sheet.PAPERSIZE_A4
    sheet.page_setup.orientation = "landscape" if landscape else "portrait"
    # A height of 0 pages: as many as the rows take.
    sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0


def _cell(value: Any) -> Any:
    """A value as a workbook holds it: no numpy types, nothing for what is not a number."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, list | tuple | dict):
        return str(value)
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _shown(value: float) -> str:
    """How a spreadsheet shows a number, whose cell holds all digits: to five, and no more than were needed."""
    if value == round(value, 2) and abs(value) < 1e5:
        return "General"
    if not 1e-2 <= abs(value) < 1e5:
        return "0.0000E+00"
    return "0" if abs(value) >= 1e4 else f"0.{'0' * (4 - int(np.floor(np.log10(max(abs(value), 1.0)))))}"
