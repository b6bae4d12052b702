"""Merged cells, prefaces, means and other lines that are no tests."""

from __future__ import annotations

import pytest
from table_import.slips import HEADER, ROWS, as_is, columns, plain, read, refused, said

PAIR = ["E (MPa)", "phi (°)"]
CELLS = {(s, t, f): (e, p) for s, t, f, e, p in ROWS}
LINES = [(s, f) for s in "AB" for f in (10, 1)]
BY_TEMPERATURE = [[s, f, *CELLS[s, 4, f], *CELLS[s, 21, f]] for s, f in LINES]
BY_QUANTITY = [[s, f, *(CELLS[s, t, f][q] for q in (0, 1) for t in (4, 21))] for s, f in LINES]


def changed(*changes):
    """The tests, with other cells at some places (row, column)."""
    rows = [list(row) for row in ROWS]
    for row, column, cell in changes:
        rows[row][column] = cell
    return [HEADER, *rows]


def every(column, cell):
    return changed(*((n, column, cell) for n in range(len(ROWS))))


def test_cells_merged_below_a_temperature_and_a_specimen(tmp_path):
    merged = changed(*((n, 0, None) for n in (1, 2, 3, 5, 6, 7)), *((n, 1, None) for n in (1, 3, 5, 7)))
    campaign = read(tmp_path, merged, "t.xlsx")
    assert plain(campaign.table) == as_is(tmp_path)
    assert said(campaign, "'T (°C)': 4 empty cells")


def test_a_gap_is_filled_only_if_both_sides_agree(tmp_path):
    assert plain(read(tmp_path, changed((1, 0, None))).table) == as_is(tmp_path)
    refused(read, tmp_path, changed((4, 0, None)), names=["t.csv, line 6: specimen", "A and B"])
    refused(read, tmp_path, changed((0, 1, None)), names=["t.csv, line 2: T (°C)", "empty"])


def test_a_test_without_a_phase_is_left_out_and_told_and_more_are_refused(tmp_path):
    campaign = read(tmp_path, changed((2, 4, None)))
    assert campaign.without_tests == ("Left out of t.csv, for its phase is empty: line 4.",)
    whole, left = as_is(tmp_path), plain(campaign.table)
    assert left == {name: [*values[:2], *values[3:]] for name, values in whole.items()}
    refused(read, tmp_path, changed((2, 4, None), (5, 4, None)), names=["t.csv, line 4: phi", "empty"])


@pytest.mark.parametrize(
    ("header", "rows"),
    [
        ([["specimen", "f (Hz)", "4 °C", None, "21 °C", None], [None, None, *PAIR, *PAIR]], BY_TEMPERATURE),
        ([[None, None, "T = 4 °C", None, "T = 21 °C"], ["specimen", "f (Hz)", *PAIR, *PAIR]], BY_TEMPERATURE),
        ([["T (°C)", None, 4, None, 21, None], ["specimen", "f (Hz)", *PAIR, *PAIR]], BY_TEMPERATURE),
        (
            [
                ["specimen", "f (Hz)", "E (MPa)", None, "phi (°)", None],
                [None, None, "4 °C", "21 °C", "4 °C", "21 °C"],
            ],
            BY_QUANTITY,
        ),
    ],
)
def test_names_in_two_lines_with_merged_cells(tmp_path, header, rows):
    campaign = read(tmp_path, [["Results", None, None], *header, *rows], "t.xlsx")
    names = ("specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
    tests = sorted(zip(*columns(campaign, *names), strict=True))
    assert tests == sorted(map(tuple, ROWS))


def test_a_preface_is_passed_over_and_said(tmp_path):
    preface = [["Project", "A 13"], ["Operator", "me"], [], ["Test", "", "", "Result"]]
    campaign = read(tmp_path, [*preface, HEADER, *ROWS])
    assert plain(campaign.table) == as_is(tmp_path)
    assert said(campaign, "'Project', 'Operator', 'Test'")


def test_what_is_no_test_is_left_out_and_said(tmp_path):
    table = [
        HEADER,
        *ROWS[:2],
        HEADER,
        *ROWS[2:],
        ["A", 30, 10, "#N/A", "#N/A"],
        ["A", 30, 1, "n.a.", ""],
        ["Mean", "", "", 9000, 20],
        ["Std. dev.", "", "", 100, 1],
        ["Note: LVDT 2 was replaced"],
        ["Checked by", "", "J. Doe"],
    ]
    campaign = read(tmp_path, table)
    assert plain(campaign.table) == as_is(tmp_path)
    assert campaign.test_type == "unknown"  # names of columns are no header of a machine
    for lines in ("line 4", "lines 11, 12", "lines 13, 14", "lines 15, 16"):
        assert said(campaign, "left out", lines)


@pytest.mark.parametrize(
    ("rows", "name", "names"),
    [
        ([HEADER, *([*row[:3], "=A1", "=A1"] for row in ROWS)], "t.xlsx", ["'E (MPa)' and 'phi (°)'"]),
        ([*zip(HEADER, *ROWS, strict=True)], "t.csv", ["t.csv", "each test has a column"]),
        ([HEADER, *(["#1", *row[1:]] for row in ROWS)], "t.csv", ["specimen '#1'"]),  # no comment
        (every(3, "27'470"), "t.csv", ["27'470"]),
        (every(3, "27 470"), "t.csv", ["27 470"]),
        (every(3, '"27,470"'), "t.csv", ["'27,470'"]),
        (changed((2, 3, "9,100")), "t.xlsx", ["line 4", "'9,100'"]),  # text in a workbook
        ([["Project", "A 13"], HEADER], "t.csv", ["no line below the names"]),
        # A number beyond all, of damaged tables.
        (
            [[*HEADER, "Frequenz"], *([*row, f"{row[2]}e0000310"] for row in ROWS)],
            "t.csv",
            ["'f (Hz)' and 'Frequenz'", "frequency_Hz"],
        ),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, rows, name, names):
    refused(read, tmp_path, rows, name, names=names)


def test_lines_may_be_numbered(tmp_path):
    numbered = [["#", *HEADER], *([n, *row] for n, row in enumerate(ROWS))]
    assert plain(read(tmp_path, numbered).table) == as_is(tmp_path)


@pytest.mark.parametrize("minus", ["−", "–"])
def test_a_minus_of_a_word_processor(tmp_path, minus):
    rows = [[s, f"{minus}{t}", *rest] for s, t, *rest in ROWS]
    assert columns(read(tmp_path, [HEADER, *rows]), "temperature_C")[0][:3] == [-4, -4, -21]


MEANS = ["Mean", "Avg", "average of 3", "Mittelwert", "Moyenne", "Std dev", "COV", "CV %"]


@pytest.mark.parametrize(
    ("specimens", "kept"),
    [(["Mean"], ["Mean"]), (["Standard 1", "B"], ["Standard 1", "B"])]
    + [([*"123", label], [*"123"]) for label in MEANS],
)
def test_lines_of_means_are_no_specimen_where_others_are(tmp_path, specimens, kept):
    tests = [[s, t, f, 9000 - 100 * t + 500 * f, 20 - f] for s in specimens for t in (5, 20) for f in (1, 10)]
    campaign = read(tmp_path, [HEADER, *tests])
    assert set(campaign.table.columns["specimen"]) == set(kept)
    assert len(campaign.table.lines) == 4 * len(kept)
