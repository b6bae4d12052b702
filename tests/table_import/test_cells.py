"""Files of cells: whatever a spreadsheet saves, and nothing that is evaluated or takes all memory."""

from __future__ import annotations

import zipfile

import openpyxl
import pytest
from table_import.slips import workbook

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import import cells
from asphalt_nscd.table_import.cells import read_cells

TABLE = [["T (°C)", "E (GPa)"], ["-10", "27,5"], ["15", "12,1"]]


def text(rows, separator):
    return "\n".join(separator.join(row) for row in rows) + "\n"


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("separator", [";", "\t"])
def test_separators_and_encodings_of_spreadsheets(tmp_path, codec, separator):
    (tmp_path / "t.csv").write_bytes(text(TABLE, separator).encode(codec))
    read = read_cells(tmp_path / "t.csv")
    assert [read.header, *(row for _, row in read.rows)] == TABLE


def test_comments_blank_lines_and_the_separator_line_of_excel_are_passed_over(tmp_path):
    (tmp_path / "t.csv").write_text("sep=;\n# a mix; of mine\n\n" + text(TABLE, ";") + ";\n# end\n")
    read = read_cells(tmp_path / "t.csv")
    assert read.header == TABLE[0]
    assert [line for line, _ in read.rows] == [5, 6]


@pytest.mark.parametrize("title", ["Results; 5 May, 2026", "Results", "Results, second run;;"])
def test_title_above_the_names_is_passed_over_and_said(tmp_path, title):
    (tmp_path / "t.csv").write_text(f"{title}\n\n" + text(TABLE, "\t"))
    read = read_cells(tmp_path / "t.csv")
    assert read.header == TABLE[0] and [line for line, _ in read.rows] == [4, 5]
    assert read.notes[-1] == f"line 1 taken for a title: {title!r}"
    (tmp_path / "t.csv").write_text("T (°C)\n-10\n15\n")
    assert read_cells(tmp_path / "t.csv").header == ["T (°C)"]


def test_quoted_decimal_commas_between_commas(tmp_path):
    (tmp_path / "t.csv").write_text('T (°C),E (GPa)\n-10,"27,5"\n')
    assert read_cells(tmp_path / "t.csv").rows == [(2, ["-10", "27,5"])]


def test_decimal_commas_between_commas_are_refused(tmp_path):
    (tmp_path / "t.csv").write_text("T (°C),E (GPa)\n-10,27,5\n")
    with pytest.raises(InputError, match=r"t\.csv, line 2: 3 fields under 2 .*with semicolons"):
        read_cells(tmp_path / "t.csv")


def test_workbook_gives_its_only_sheet_or_the_one_named(tmp_path):
    rows = [["T (°C)", "E (GPa)"], [-10, 27.5], [None, None], ["# cold", None], [15, 4.2]]
    one = read_cells(workbook(tmp_path / "t.xlsx", results=rows, empty=[]))
    assert one.rows == [(2, ["-10", "27.5"]), (5, ["15", "4.2"])]
    two = workbook(tmp_path / "t.xlsx", first=rows, second=[["a"], [1]])
    with pytest.raises(InputError, match="sheets first, second all hold something; name one with --sheet"):
        read_cells(two)
    assert read_cells(two, "second").rows == [(2, ["1"])]
    with pytest.raises(InputError, match="no sheet 'third'; give one of first, second"):
        read_cells(two, "third")


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
    with pytest.raises(InputError, match="more than 20000 rows"):
        read_cells(workbook(tmp_path / "u.xlsx", a=[["T"]] + [[1]] * (cells.MOST_ROWS + 5)))


def test_archive_that_unpacks_to_much_more_is_refused_before_it_is_unpacked(tmp_path):
    with zipfile.ZipFile(tmp_path / "t.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * (cells.MOST_UNPACKED + 1))
    with pytest.raises(InputError, match="unpacks to 50 MB"):
        read_cells(tmp_path / "t.xlsx")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "the file is empty; export it anew"),
        (b"# only\n", "holds no tests"),
        (b"a,b\n", "holds no tests; give one line of column names, and below it a line for each test"),
        (b"a,b\n\0,1\n", "not text"),
        (b'a,b\n"1,2\n', "not CSV"),
        (b"PK\x03\x04rubbish", "cannot be read as XLSX"),
        (b"\xd0\xcf\x11\xe0rubbish", "old or encrypted Excel file"),
    ],
)
def test_what_is_no_table_is_refused_in_one_sentence(tmp_path, content, sentence):
    (tmp_path / "t").write_bytes(content)
    with pytest.raises(InputError, match=sentence) as error:
        read_cells(tmp_path / "t")
    assert "\n" not in str(error.value)


def test_large_file_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / "t.csv").open("wb") as file:
        file.truncate(cells.MOST_BYTES + 1)
    with pytest.raises(InputError, match="larger than 20 MB"):
        read_cells(tmp_path / "t.csv")
