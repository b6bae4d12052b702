"""Files of cells: whatever a spreadsheet saves, and nothing that is evaluated or takes all memory."""

from __future__ import annotations

import codecs
import zipfile

import openpyxl
import pytest
from table_import.slips import refused, workbook

from asphalt_nscd.table_import import cells
from asphalt_nscd.table_import.cells import read_cells

TABLE = [["T (°C)", "E (GPa)"], ["-10", "27,5"], ["15", "12,1"]]


def text(separator):
    return "\n".join(separator.join(row) for row in TABLE) + "\n"


def read(folder, content):
    (folder / "t.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_cells(folder / "t.csv")


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "utf-16", "big-endian", "cp1252"])
@pytest.mark.parametrize("separator", [";", "\t"])
def test_separators_and_encodings_of_spreadsheets(tmp_path, codec, separator):
    content = text(separator)
    marked = (
        codecs.BOM_UTF16_BE + content.encode("utf-16-be") if codec == "big-endian" else content.encode(codec)
    )
    table = read(tmp_path, marked)
    assert [table.header, *(row for _, row in table.rows)] == TABLE


@pytest.mark.parametrize(
    ("above", "separator", "lines"),
    [
        ("sep=;\n# a mix; of mine\n\n", ";", [5, 6]),
        ("Results; 5 May, 2026\n\n", "\t", [4, 5]),
        ("Results\n\n", "\t", [4, 5]),
        ("Results, second run;;\n\n", "\t", [4, 5]),
    ],
)
def test_what_stands_above_the_names_and_below_the_tests_is_passed_over(tmp_path, above, separator, lines):
    table = read(tmp_path, above + text(separator) + f"{separator}\n# end\n")
    assert table.header == TABLE[0]
    assert [line for line, _ in table.rows] == lines


def test_one_column_has_no_title(tmp_path):
    assert read(tmp_path, "T (°C)\n-10\n15\n").header == ["T (°C)"]


def test_decimal_commas_between_commas_are_quoted_or_refused(tmp_path):
    assert read(tmp_path, 'T (°C),E (GPa)\n-10,"27,5"\n').rows == [(2, ["-10", "27,5"])]
    refused(read, tmp_path, "T (°C),E (GPa)\n-10,27,5\n", names=["t.csv, line 2: 3 fields"])


def test_workbook_gives_its_only_sheet_or_the_one_named(tmp_path):
    rows = [["T (°C)", "E (GPa)"], [-10, 27.5], [None, None], ["# cold", None], [15, 4.2]]
    alone = read_cells(workbook(tmp_path / "t.xlsx", results=rows, empty=[]))
    assert alone.rows == [(2, ["-10", "27.5"]), (5, ["15", "4.2"])]
    two = workbook(tmp_path / "t.xlsx", first=rows, second=[["a"], [1]])
    assert read_cells(two, "second").rows == [(2, ["1"])]
    refused(read_cells, two, names=["t.xlsx", "first, second"])
    refused(read_cells, two, "third", names=["t.xlsx", "'third'", "first, second"])


def test_formulas_are_not_computed(tmp_path):
    path = workbook(tmp_path / "t.xlsx", a=[["T (°C)", "E (GPa)"], [1, "=1+1"], [2, '=HYPERLINK("x")']])
    assert [row for _, row in read_cells(path).rows] == [["1", ""], ["2", ""]]


def test_sheet_is_not_read_to_a_cell_far_away(tmp_path, monkeypatch):
    monkeypatch.setattr(cells, "MOST_ROWS", 200)  # the sentence was made before
    book = openpyxl.Workbook()
    book.active["A1"], book.active["XFD1048576"] = "T (°C)", 1
    book.active["A2"] = 5
    book.save(tmp_path / "t.xlsx")
    assert len(read_cells(tmp_path / "t.xlsx").rows) == 1
    assert len(read_cells(workbook(tmp_path / "u.xlsx", a=[["T"]] + [[1]] * 199)).rows) == 199
    refused(read_cells, workbook(tmp_path / "u.xlsx", a=[["T"]] + [[1]] * 200), names=["u.xlsx"])


def test_what_takes_all_memory_is_refused_before_it_is_read(tmp_path):
    with zipfile.ZipFile(tmp_path / "t.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * (cells.MOST_UNPACKED + 1))
    refused(read_cells, tmp_path / "t.xlsx", names=["t.xlsx", "50 MB"])
    with (tmp_path / "t.csv").open("wb") as file:
        file.truncate(cells.MOST_BYTES + 1)
    refused(read_cells, tmp_path / "t.csv", names=["t.csv", "20 MB"])


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (b"", "empty"),
        (b"# only\n", "no tests"),
        (b"a,b\n", "no tests"),
        (b"a,b\n\0,1\n", "not text"),
        (b"%PDF-1.4\na,b\n1,2\n", "not text"),
        (b'a,b\n"1,2\n', "not CSV"),
        (b"PK\x03\x04rubbish", "workbook"),
        (b"\xd0\xcf\x11\xe0rubbish", "workbook"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, content, name):
    refused(read, tmp_path, content, names=["t.csv", name])
