"""Workbooks as laboratories keep them: merged heads, means without a word, hidden rows, other programs' formats."""

from __future__ import annotations

import statistics
import struct
import zipfile
from itertools import product

import openpyxl
import pytest
from layouts.files import save_ods
from layouts.laboratory import Laboratory
from table_import.slips import plain, read, refused, said, workbook

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.decimals import Number

TEMPERATURES, FREQUENCIES, SPECIMENS = (4, 21, 37), (10, 1), "123"
KEYS = ["T (°C)", "f (Hz)"]


def modulus(s, t, f):
    return 15000 - 350 * t + 90 * f + 400 * int(s) + 10 * ((t * int(s)) % 7)


def phase(s, t, f):
    return round(8 + 0.6 * t - 0.2 * f + 0.4 * int(s) + 0.1 * ((t + int(s)) % 3), 1)


TESTS = {
    (s, t, f): (modulus(s, t, f), phase(s, t, f)) for s, t, f in product(SPECIMENS, TEMPERATURES, FREQUENCIES)
}


def held(campaign):
    table = plain(campaign.table)
    columns = (table[name] for name in ("specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"))
    return {(s[-1], t, f): (e, p) for s, t, f, e, p in zip(*columns, strict=True)}


def statistics_of(t, f):
    """Mean, deviation and CV of |E*| and phase over the specimens, as a spreadsheet shows them."""
    both = [[TESTS[s, t, f][which] for s in SPECIMENS] for which in (0, 1)]
    means, deviations = [statistics.mean(x) for x in both], [statistics.stdev(x) for x in both]
    yield round(means[0]), round(means[1], 1)
    yield round(deviations[0]), round(deviations[1], 2)
    yield tuple(round(100 * deviation / mean, 1) for deviation, mean in zip(deviations, means, strict=True))


@pytest.mark.parametrize("words", [("Ave", "SD", "CV"), ("Xquer", "sx", "V%"), ("平均",)])
@pytest.mark.parametrize("as_columns", [False, True])
def test_means_and_deviations_are_known_by_their_numbers_in_any_language(tmp_path, words, as_columns):
    table = {(t, f): [TESTS[s, t, f] for s in SPECIMENS] for t, f in product(TEMPERATURES, FREQUENCIES)}
    names = [*SPECIMENS, *words]
    for key, cells in table.items():
        cells += list(statistics_of(*key))[: len(words)]
    if as_columns:
        head = [[*KEYS, "E* (MPa)", *[None] * (len(names) - 1), "phase (°)"], [None, None, *names, *names]]
        rows = [
            *head,
            *([t, f, *(c[0] for c in cells), *(c[1] for c in cells)] for (t, f), cells in table.items()),
        ]
    else:
        rows = [["specimen", *KEYS, "E* (MPa)", "phase (°)"]]
        rows += [
            [s, *key, *cell] for key, cells in table.items() for s, cell in zip(names, cells, strict=True)
        ]
    campaign = read(tmp_path, rows, "t.xlsx")
    assert held(campaign) == TESTS
    assert said(campaign, "left out, means and deviations")


def test_a_specimen_near_the_mean_of_the_others_stays(tmp_path):
    rows = [["specimen", *KEYS, "E* (MPa)", "phase (°)"]]
    for t, f in product(TEMPERATURES, FREQUENCIES):
        (e1, p1), (e2, p2), _ = (TESTS[s, t, f] for s in SPECIMENS)
        off = 20 if f == 10 else 0  # 0.2 per cent
        rows += [["1", t, f, e1, p1], ["2", t, f, e2, p2], ["3", t, f, (e1 + e2) / 2 + off, (p1 + p2) / 2]]
    assert set(plain(read(tmp_path, rows, "t.xlsx").table)["specimen"]) == set(SPECIMENS)


def long(tests=TESTS):
    return [["specimen", *KEYS, "E* (MPa)", "phase (°)"], *([*key, *both] for key, both in tests.items())]


def test_hidden_rows_are_read_and_told(tmp_path):
    path = workbook(tmp_path / "t.xlsx", results=long())
    book = openpyxl.load_workbook(path)
    book["results"].row_dimensions[3].hidden = book["results"].row_dimensions[5].hidden = True
    book["results"].column_dimensions.group("B", "D", hidden=True)
    book.save(path)
    campaign, _ = read_campaign([path])
    assert held(campaign) == TESTS
    assert said(campaign, "hidden rows 3, 5 and columns 2, 3, 4")


def test_a_sheet_may_be_named_with_a_minus_sign(tmp_path):
    cold = {(s, -t, f): both for (s, t, f), both in TESTS.items()}
    sheets = {
        f"\N{MINUS SIGN}{t} °C": [
            ["specimen", "f (Hz)", "E* (MPa)", "phase (°)"],
            *([s, f, *both] for (s, u, f), both in cold.items() if u == -t),
        ]
        for t in TEMPERATURES
    }
    assert held(read(tmp_path, sheets, "t.xlsx")) == cold


def test_a_workbook_of_open_document_is_read(tmp_path):
    (tmp_path / "mix").mkdir()
    save_ods(tmp_path / "mix/t.ods", {"Sheet1": long()}, Laboratory(0))
    assert held(read_campaign([tmp_path / "mix"])[0]) == TESTS


def binary_workbook(path, rows):
    """A workbook as Excel keeps it in binary; `rows` by their number."""

    def record(kind, data=b""):
        head = bytes([kind]) if kind < 128 else bytes([kind & 127 | 128, kind >> 7])
        return head + bytes([len(data) & 127 | 128, len(data) >> 7]) + data

    def text(value):
        return struct.pack("<I", len(value)) + value.encode("utf-16-le")

    sheet = record(0x81) + record(0x94, struct.pack("<4I", 0, 1, 0, 4)) + record(0x91)
    for number, row in rows.items():
        sheet += record(0, struct.pack("<IIHBBBI", number, 0, 300, 0, 0, 0, 0))
        for column, value in enumerate(row):
            place = struct.pack("<II", column, 0)
            cell = (6, text(value)) if isinstance(value, str) else (5, struct.pack("<d", value))
            sheet += record(cell[0], place + cell[1])
    sheet += record(0x92) + record(0x82)
    named = record(0x9C, struct.pack("<II", 0, 1) + text("rId1") + text("Data"))
    office = "http://schemas.openxmlformats.org"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("xl/worksheets/sheet1.bin", sheet)
        archive.writestr("xl/workbook.bin", record(0x83) + record(0x8F) + named + record(0x90) + record(0x84))
        archive.writestr(
            "xl/_rels/workbook.bin.rels",
            f'<Relationships xmlns="{office}/package/2006/relationships">'
            f'<Relationship Id="rId1" Target="worksheets/sheet1.bin" '
            f'Type="{office}/officeDocument/2006/relationships/worksheet"/></Relationships>',
        )
    return path


def test_a_binary_workbook_is_read_and_refused_if_a_cell_is_far_away(tmp_path):
    rows = dict(enumerate(long()))
    assert held(read_campaign([binary_workbook(tmp_path / "t.xlsb", rows)])[0]) == TESTS
    far = binary_workbook(tmp_path / "far.xlsb", rows | {1_000_000: [1.0]})
    refused(read_campaign, [far], names=["far.xlsb", "more than"])


def test_the_mend_names_the_column_and_its_unit(tmp_path):
    rows = [
        ["specimen", *KEYS, "Wert (GPa)", "Winkel [rad]"],
        *([*key, e / 1e3, 0.2] for key, (e, _) in TESTS.items()),
    ]
    refused(read, tmp_path, rows, "t.xlsx", names=['--column E_GPa="Wert"', '--column phase_rad="Winkel"'])
    for names in (
        {"E_GPa": "Wert", "phase_rad": "Winkel"},
        {"E_GPa": "Wert (GPa)", "phase_rad": "Winkel [rad]"},
    ):
        campaign = read(tmp_path, rows, "t.xlsx", **names)
        assert {key: e for key, (e, _) in held(campaign).items()} == {key: e for key, (e, _) in TESTS.items()}


def test_four_names_are_offered_for_one_quantity(tmp_path):
    names = [f"Wert{letter} (GPa)" for letter in "abcde"]
    rows = [
        ["specimen", *KEYS, *names, "phase (°)"],
        *([*key, *[e / 1e3] * 5, p] for key, (e, p) in TESTS.items()),
    ]
    with pytest.raises(InputError, match='"Wertd", or write') as caught:
        read(tmp_path, rows, "t.xlsx")
    assert "Werte" not in str(caught.value)


def test_a_word_is_said_wherever_it_stands_but_not_in_another_unit(tmp_path):
    rows = [
        [None, "Moduuli 4 °C", "Moduuli 20 °C", "Kulma 4 °C (°)", "Kulma 20 °C (°)"],
        [1, 9e3, 5e3, 12, 20],
    ]
    rows = [["f (Hz)", *rows[0][1:]], *rows[1:], [10, 12e3, 7e3, 9, 16]]
    campaign = read(tmp_path, rows, "t.xlsx", E_MPa="Moduuli", phase_deg="Kulma")
    assert sorted(campaign.table.numbers("E_MPa")) == [5e3, 7e3, 9e3, 12e3]
    refused(read, tmp_path, rows, "t.xlsx", names=["Kulma"], E_MPa="Moduuli", phase_rad="Kulma")


def test_tables_below_lines_of_their_specimens(tmp_path):
    rows = []
    for s in SPECIMENS:
        rows += [["Specimen ref.", s], ["Date of test", "12/05/2023"], [*KEYS, "E* (MPa)", "phase (°)"]]
        rows += [[*key, *both] for (one, *key), both in TESTS.items() if one == s]
    assert held(read(tmp_path, rows, "t.xlsx")) == TESTS
    assert held(read(tmp_path, [[None, *row] for row in rows], "t.xlsx")) == TESTS
    unnamed = [row for n, row in enumerate(rows) if row[0] != KEYS[0] or n == 2]
    refused(read, tmp_path, unnamed, "t.xlsx", names=["line 10", "stands among the tests"])


@pytest.mark.parametrize(
    ("value", "text"),
    [(21.0, "21"), (4.2 + 1e-15, "4.2"), (-999999999999999.0, "-999999999999999"), (1e15, "1e+15")],
)
def test_a_number_of_a_workbook_is_written_as_a_person_would_and_kept_in_full(value, text):
    assert Number(value) == text and Number(value).value == value
