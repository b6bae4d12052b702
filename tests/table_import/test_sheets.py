"""Workbooks of several sheets."""

from __future__ import annotations

import openpyxl
import pytest
from table_import.slips import HEADER, ROWS, as_is, read, refusal, said

from asphalt_nscd.table_import.campaign import read_campaign


def by_specimen(*more):
    return {name: [HEADER[1:], *(row[1:] for row in ROWS if row[0] == name)] for name in "AB"} | dict(more)


def test_all_sheets_of_one_layout_are_read_as_specimens(tmp_path):
    info = ("Info", [["Project", "X"], ["Operator", "me"]])
    mean = ("Mean", [HEADER[1:], *([*row[1:3], row[3] + 3, row[4]] for row in ROWS[:4])])
    campaign = read(tmp_path, by_specimen(info, mean), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "2 sheets of t.xlsx read: A, B; --sheet takes one alone")
    assert said(campaign, "specimen from the name of the sheet")
    assert said(campaign, "skipped sheet Info of t.xlsx (") and said(
        campaign, "skipped sheet Mean of t.xlsx (its name"
    )
    alone = read_campaign([tmp_path / "t.xlsx"], sheet="B")[0]
    assert len(alone.table.lines) == 4 and alone.files == (tmp_path / "t.xlsx",)


@pytest.mark.parametrize("name", ["Summary", "Sheet1"])
def test_a_sheet_whose_headings_say_means_is_no_specimen(tmp_path, name):
    head = ["T (°C)", "f (Hz)", "Average |E*| (MPa)", "Std Dev |E*| (MPa)", "Average phase (°)"]
    rows = [[*row[1:3], row[3] + 3, 12.1, row[4]] for row in ROWS[:4]]
    campaign = read(tmp_path, by_specimen((name, [head, *rows])), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, f"sheet {name}")


@pytest.mark.parametrize("name", ["Master curve", "Curve"])
def test_a_sheet_of_the_master_curve_is_passed_over(tmp_path, name):
    head = ["T (°C)", "Reduced frequency (Hz)", "|E*| (MPa)", "Predicted |E*| (MPa)"]
    curve = (name, [head, *([*row[1:4], row[3]] for row in ROWS)])
    campaign = read(tmp_path, {"Data": [HEADER, *ROWS]} | dict([curve]), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, f"skipped sheet {name} of t.xlsx")


def test_each_sheet_may_have_its_line_of_units(tmp_path):
    units = [["T", "f", "E*", "phi"], ["°C", "Hz", "MPa", "°"]]
    sheets = {f"{name}1": [*units, *rows[1:]] for name, rows in by_specimen().items()}
    columns = read(tmp_path, sheets, "t.xlsx").table.columns
    whole = as_is(tmp_path)
    assert columns == whole | {"specimen": [f"{name}1" for name in whole["specimen"]]}


def test_a_sheet_of_all_tests_is_not_read_twice(tmp_path):
    campaign = read(tmp_path, by_specimen(("All", [HEADER, *ROWS])), "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(
        campaign, "skipped t.xlsx, sheet All (holds the same tests as t.xlsx, sheet A, t.xlsx, sheet B)"
    )


def test_sheets_of_temperatures(tmp_path):
    sheets = {
        f"{t} °C": [[HEADER[0], *HEADER[2:]], *([r[0], *r[2:]] for r in ROWS if r[1] == t)] for t in (4, 21)
    }
    campaign = read(tmp_path, sheets, "t.xlsx")
    assert sorted(zip(*campaign.table.columns.values(), strict=True)) == sorted(
        zip(*as_is(tmp_path).values(), strict=True)
    )
    both = {
        f"{s} {t}C": [HEADER[2:], *(r[2:] for r in ROWS if r[:2] == [s, t])] for s in "AB" for t in (4, 21)
    }
    assert read(tmp_path, both, "t.xlsx").table.columns == as_is(tmp_path)


def test_an_error_in_one_sheet_names_it(tmp_path):
    sheets = by_specimen()
    sheets["B"][2][2] = "many"
    assert "t.xlsx, sheet B, line 3: E (MPa): 'many' is not a number" in refusal(tmp_path, sheets, "t.xlsx")


def test_a_hidden_sheet_is_not_read(tmp_path):
    read(tmp_path, by_specimen(), "t.xlsx")
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    book["A"].sheet_state = "hidden"
    book.save(tmp_path / "t.xlsx")
    campaign, _ = read_campaign([tmp_path / "t.xlsx"])
    assert len(campaign.table.lines) == 4 and said(campaign, "hidden sheet A not read")
