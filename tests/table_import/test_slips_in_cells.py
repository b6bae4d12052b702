"""Merged cells, prefaces, means and other lines that are no tests."""

from __future__ import annotations

import pytest
from table_import.slips import HEADER, ROWS, as_is, columns, read, refusal, said

from asphalt_nscd.table_import.campaign import read_campaign


def test_cells_merged_below_a_temperature_and_a_specimen(tmp_path):
    merged = [
        [s if n % 4 == 0 else None, t if n % 2 == 0 else None, *rest] for n, (s, t, *rest) in enumerate(ROWS)
    ]
    campaign = read(tmp_path, [HEADER, *merged], "t.xlsx")
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "'T (°C)': 4 empty cells with the value above, as in merged cells")


def test_a_gap_is_filled_only_if_both_sides_agree(tmp_path):
    gap = [list(row) for row in ROWS]
    gap[1][0] = None
    assert read(tmp_path, [HEADER, *gap]).table.columns == as_is(tmp_path)
    gap[4][0] = None  # the first of specimen B
    assert "line 6: specimen is empty between A and B; fill it in" in refusal(tmp_path, [HEADER, *gap])
    gap[0][1] = None
    gap[4][0] = "B"
    assert "line 2: T (°C): the cell is empty" in refusal(tmp_path, [HEADER, *gap])


@pytest.mark.parametrize(
    "header",
    [
        [
            ["specimen", "f (Hz)", "4 °C", None, "21 °C", None],
            [None, None, "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
        [
            [None, None, "T = 4 °C", None, "T = 21 °C"],
            ["specimen", "f (Hz)", "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
        [
            ["T (°C)", None, 4, None, 21, None],
            ["specimen", "f (Hz)", "E (MPa)", "phi (°)", "E (MPa)", "phi (°)"],
        ],
    ],
)
def test_names_in_two_lines_with_merged_cells(tmp_path, header):
    cells = {(s, t, f): (e, p) for s, t, f, e, p in ROWS}
    rows = [[s, f, *cells[s, 4, f], *cells[s, 21, f]] for s in "AB" for f in (10, 1)]
    campaign = read(tmp_path, [["Results", None, None], *header, *rows], "t.xlsx")
    assert sorted(
        zip(*columns(campaign, "specimen", "temperature_C", "frequency_Hz", "E_MPa"), strict=True)
    ) == sorted((s, str(t), str(f), str(e)) for s, t, f, e, _ in ROWS)
    assert said(campaign, "names of columns from lines 2 and 3")


def test_quantities_merged_above_temperatures(tmp_path):
    header = [
        ["specimen", "f (Hz)", "E (MPa)", None, "phi (°)", None],
        [None, None, "4 °C", "21 °C", "4 °C", "21 °C"],
    ]
    cells = {(s, t, f): (e, p) for s, t, f, e, p in ROWS}
    rows = [[s, f, *(cells[s, t, f][q] for q in (0, 1) for t in (4, 21))] for s in "AB" for f in (10, 1)]
    assert len(read(tmp_path, [*header, *rows], "t.xlsx").table.lines) == len(ROWS)


def test_a_preface_is_passed_over_and_said(tmp_path):
    preface = [["Project", "A 13"], ["Operator", "me"], [], ["Test", "", "", "Result"]]
    campaign = read(tmp_path, [*preface, HEADER, *ROWS])
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "lines above the names passed over: 'Project', 'Operator', 'Test'")


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
    assert campaign.table.columns == as_is(tmp_path)
    assert said(campaign, "left out, names of columns repeated: line 4")
    assert said(campaign, "left out, neither modulus nor phase: lines 11, 12")
    assert said(campaign, "left out, means and deviations of other lines: lines 13, 14")
    assert said(campaign, "left out, no number of a test: lines 15, 16 ('Note: LVDT 2 was replaced')")


def test_a_table_of_formulas_that_were_not_computed(tmp_path):
    empty = [[*row[:3], "=A1", "=A1"] for row in ROWS]
    assert "no line has a number in 'E (MPa)' and 'phi (°)' (formulas" in refusal(
        tmp_path, [HEADER, *empty], "t.xlsx"
    )


def test_a_table_lying_on_its_side(tmp_path):
    assert "t.csv: each test has a column; turn the table" in refusal(
        tmp_path, list(zip(HEADER, *ROWS, strict=True))
    )


def test_specimens_called_by_a_number_sign_are_no_comments(tmp_path):
    assert "specimen '#1' must begin with a letter" in refusal(
        tmp_path, [HEADER, *(["#1", *row[1:]] for row in ROWS)]
    )
    numbered = [["#", *HEADER], *([n, *row] for n, row in enumerate(ROWS))]
    assert read(tmp_path, numbered).table.columns == as_is(tmp_path)


@pytest.mark.parametrize("minus", ["−", "–"])
def test_a_minus_of_a_word_processor(tmp_path, minus):
    rows = [[s, f"{minus}{t}", *rest] for s, t, *rest in ROWS]
    assert columns(read(tmp_path, [HEADER, *rows]), "temperature_C")[0][:3] == ["-4", "-4", "-21"]


def test_grouped_digits_are_named_as_such(tmp_path):
    for text in ("27'470", "27 470"):
        rows = [[*row[:3], text, 20] for row in ROWS]
        assert "470' seems to group its digits" in refusal(tmp_path, [HEADER, *rows]).replace('"', "'")
    rows = [[*row[:3], '"27,470"', 20.5] for row in ROWS]
    assert (
        "or '27,470' groups its digits in thousands; write all numbers with the same and without"
        in refusal(tmp_path, [HEADER, *rows])
    )


def test_a_table_repeated_under_its_names_is_no_export(tmp_path):
    """Names of columns are no header of a machine, even if one of them is `specimen`."""
    campaign = read(tmp_path, [HEADER, *ROWS[:4], HEADER, *ROWS[4:]])
    assert campaign.table.columns == as_is(tmp_path) and campaign.test_type == "unknown"


def test_names_without_a_line_of_tests(tmp_path):
    """Found by damaged tables: names in the last line, and a number beyond all."""
    assert "no line below the names of columns" in refusal(tmp_path, [["Project", "A 13"], HEADER])
    twice = [[*HEADER, "Frequenz"], *([*row, f"{row[2]}e0000310"] for row in ROWS)]
    assert "columns 'f (Hz)' and 'Frequenz' may each be frequency_Hz" in refusal(tmp_path, twice)


@pytest.mark.parametrize(
    "label", ["Mean", "Avg", "average of 3", "Mittelwert", "Moyenne", "Std dev", "COV", "CV %"]
)
def test_lines_of_means_are_no_specimen(tmp_path, label):
    head = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg"
    tests = [
        f"{s},{t},{f},{9000 - 100 * t + 500 * f},{20 - f}" for s in "123" for t in (5, 20) for f in (1, 10)
    ]
    means = [f"{label},{t},{f},{9000 - 100 * t + 500 * f},{20 - f}" for t in (5, 20) for f in (1, 10)]
    (tmp_path / "t.csv").write_text("\n".join([head, *tests, *means]) + "\n")
    campaign, _ = read_campaign([tmp_path / "t.csv"])
    assert set(campaign.table.columns["specimen"]) == {"1", "2", "3"}
    assert any(
        "left out, means and deviations of other lines: lines 14, 15, 16, 17" in n for n in campaign.notes
    )


def test_a_table_of_means_alone_and_a_specimen_called_standard(tmp_path):
    head = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg"
    (tmp_path / "t.csv").write_text(f"{head}\nMean,5,1,9000,20\nMean,5,10,12000,15\n")
    assert set(read_campaign([tmp_path / "t.csv"])[0].table.columns["specimen"]) == {"Mean"}
    (tmp_path / "t.csv").write_text(f"{head}\nStandard 1,5,1,9000,20\nB,5,10,12000,15\n")
    assert set(read_campaign([tmp_path / "t.csv"])[0].table.columns["specimen"]) == {"Standard 1", "B"}
