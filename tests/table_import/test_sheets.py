"""Workbooks of several sheets."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pytest
from table_import.slips import HEADER, ROWS, as_is, plain, read, said

from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.rows_of_tests import _all_at

INFO = [["Project", "X"], ["Operator", "me"]]
MEAN = [HEADER[1:], *([*row[1:3], row[3] + 3, row[4]] for row in ROWS[:4])]
MEANS = [["T (°C)", "f (Hz)", "Average |E*| (MPa)", "Std Dev |E*| (MPa)", "Average phase (°)"]]
MEANS += [[*row[1:3], row[3] + 3, 12.1, row[4]] for row in ROWS[:4]]
CURVE = [["T (°C)", "Reduced frequency (Hz)", "|E*| (MPa)", "Predicted |E*| (MPa)"]]
CURVE += [[*row[1:4], row[3]] for row in ROWS]
DATA = {"Data": [HEADER, *ROWS]}


def by_specimen():
    return {name: [HEADER[1:], *(row[1:] for row in ROWS if row[0] == name)] for name in "AB"}


def rows_of(campaign):
    return sorted(zip(*plain(campaign.table).values(), strict=True))


def test_all_sheets_of_one_layout_are_read_as_specimens(tmp_path):
    campaign = read(tmp_path, by_specimen(), "t.xlsx")
    assert plain(campaign.table) == as_is(tmp_path)
    assert said(campaign, "t.xlsx", "A, B")
    alone = read_campaign([tmp_path / "t.xlsx"], sheet="B")[0]
    assert len(alone.table.lines) == 4
    assert alone.files == (tmp_path / "t.xlsx",)


@pytest.mark.parametrize(
    ("sheets", "name", "more"),
    [
        (by_specimen(), "Info", INFO),
        (by_specimen(), "Mean", MEAN),
        (by_specimen(), "Summary", MEANS),
        (by_specimen(), "Sheet1", MEANS),
        (DATA, "Master curve", CURVE),
        (DATA, "Curve", CURVE),
        (by_specimen(), "All", [HEADER, *ROWS]),
    ],
)
def test_a_sheet_that_is_no_specimen_is_passed_over_and_said(tmp_path, sheets, name, more):
    campaign = read(tmp_path, sheets | {name: more}, "t.xlsx")
    assert plain(campaign.table) == as_is(tmp_path)
    assert said(campaign, f"sheet {name}")


def test_each_sheet_may_have_its_line_of_units(tmp_path):
    units = [["T", "f", "E*", "phi"], ["°C", "Hz", "MPa", "°"]]
    sheets = {f"{name}1": [*units, *rows[1:]] for name, rows in by_specimen().items()}
    whole = as_is(tmp_path)
    expected = whole | {"specimen": [f"{name}1" for name in whole["specimen"]]}
    assert plain(read(tmp_path, sheets, "t.xlsx").table) == expected


def test_sheets_of_temperatures(tmp_path):
    without = [HEADER[0], *HEADER[2:]]
    sheets = {f"{t} °C": [without, *([r[0], *r[2:]] for r in ROWS if r[1] == t)] for t in (4, 21)}
    expected = sorted(zip(*as_is(tmp_path).values(), strict=True))
    assert rows_of(read(tmp_path, sheets, "t.xlsx")) == expected
    pairs = [(s, t) for s in "AB" for t in (4, 21)]
    both = {f"{s} {t}C": [HEADER[2:], *(r[2:] for r in ROWS if r[:2] == [s, t])] for s, t in pairs}
    assert plain(read(tmp_path, both, "t.xlsx").table) == as_is(tmp_path)


def test_a_hidden_sheet_is_not_read(tmp_path):
    read(tmp_path, by_specimen(), "t.xlsx")
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    book["A"].sheet_state = "hidden"
    book.save(tmp_path / "t.xlsx")
    campaign, _ = read_campaign([tmp_path / "t.xlsx"])
    assert len(campaign.table.lines) == 4
    assert said(campaign, "hidden sheet A")


@pytest.mark.parametrize(
    ("name", "values", "alike"), [("T (°F)", ["68", "68.9"], True), ("T (°F)", ["20", "20"], False)]
)
def test_the_temperature_in_a_sheet_s_name_is_that_of_its_tests_in_their_unit(name, values, alike):
    cells = Cells(Path("t.xlsx"), [name], [(n, [value]) for n, value in enumerate(values)])
    assert _all_at(cells, "20") == alike
