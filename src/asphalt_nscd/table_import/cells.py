"""Tables as people have them, text or workbook, as cells. Nothing in them is evaluated."""

from __future__ import annotations

import csv
import io
import re
import warnings
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.decimals import Number

MOST_BYTES = 20_000_000
# Known from the archive's list before anything is unpacked: 20 MB may unpack to gigabytes.
MOST_UNPACKED = 50_000_000  # bytes of XML in an XLSX file
MOST_ROWS, MOST_COLUMNS = 20_000, 300
MOST_REMARKS = 1000  # lines of a text file beside its rows
TOO_MANY = f"more than {MOST_ROWS} rows or {MOST_COLUMNS} columns; give the table of results alone."

_FREQUENCY = r"\d\s*Hz\b"
# Not `#`, the name of a column of numbers, `#1`, that of a specimen, nor `#N/A`.
_REMARK = re.compile(r"\s*#(?![\dA-Z]|\s*(?:[,;\t\"]|$))")

Row = tuple[int, list[str]]  # line in the file, from 1, and its fields


class UnreadNames(InputError):
    """A table whose columns cannot be told, perhaps for the words that name them."""


class NotTests(UnreadNames):
    """A file that holds no tests at all; in a folder it is passed over and named."""


@dataclass(frozen=True)
class Sheet:
    """Rows, with their lines, of a sheet of a workbook, or of a text file (`name` None); `notes` tell how read.

    `alone`: no other sheet of the file holds something.
    """

    file: Path
    name: str | None
    rows: list[Row]
    notes: list[str]
    alone: bool = True

    @property
    def path(self) -> Path:
        """The file as sentences call it: of several sheets with the sheet as a part of its name."""
        return self.file if self.alone else self.file.with_name(f"{self.file.name}, sheet {self.name}")

    @property
    def called(self) -> str:
        """What names the tests of a file or a sheet, if nothing in it does."""
        return self.file.stem if self.alone else str(self.name)


@dataclass(frozen=True)
class Cells:
    """A header, and below it rows of text as long as it, with their lines; `notes` tell how they were read.

    `at` has for each column the conditions that lines above its name give it, as in `Heading.at`.
    """

    path: Path
    header: list[str]
    rows: list[Row]
    notes: list[str] = field(default_factory=list)
    at: list[dict[str, str]] | None = None


@dataclass(frozen=True)
class Block:
    """The tests of one table, as cells with one row for each test.

    Of a machine's export (`exported`), where a block is of one specimen at one temperature: `repeated`, the operator
    marked it as a repetition; `tested`, its date as the header has it; `contested`, the temperature [degC] that name or
    header say beside the one taken; `unnamed`, no header names the specimen, and the file's name says no temperature:
    it may be that of a test. `means`: all results are means of others.
    """

    cells: Cells
    exported: bool = False
    repeated: bool = False
    tested: str = ""
    contested: str = ""
    unnamed: bool = False
    means: bool = False


def read_cells(path: str | Path, sheet: str | None = None) -> Cells:
    """Cells of a file with one table, below its line of names; several sheets with content need `sheet`."""
    sheets = read_sheets(path, sheet)
    if len(sheets) > 1:
        names = ", ".join(str(one.name) for one in sheets)
        raise InputError(f"{path}: sheets {names} all hold something; name one with --sheet.")
    return build_cells(Path(path), sheets[0].rows, sheets[0].notes)


def read_sheets(path: str | Path, sheet: str | None = None) -> list[Sheet]:
    """The sheets of a text file or a workbook, at least one; blank rows and those that begin with # are left out.

    Raises NotTests, not InputError, for a file that is empty or holds no table.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file; check the path.")
    if path.stat().st_size > MOST_BYTES:
        raise InputError(f"{path}: larger than {MOST_BYTES // 10**6} MB; give the table of results alone.")
    start = path.read_bytes()[:8]
    # An archive, or the container of Excel before 2007, in which later ones wrap a workbook with a password.
    if start.startswith((b"PK", b"\xd0\xcf\x11\xe0")):
        sheets = _workbook(path, sheet)
    else:
        sheets = [Sheet(path, None, *_text(path))]
    sheets = [replace(one, rows=_held(one.rows)) for one in sheets]
    sheets = [one for one in sheets if len(one.rows) > 1]
    if len(sheets) > 1:
        notes = [[note for note in one.notes if note != f"sheet {one.name}"] for one in sheets]
        sheets = [replace(one, notes=told, alone=False) for one, told in zip(sheets, notes, strict=True)]
    if not sheets and not path.read_bytes().strip():
        raise NotTests(f"{path}: the file is empty; export it anew.")
    if not sheets:
        raise NotTests(
            f"{path}: holds no tests; give one line of column names, and below it a line for each test."
        )
    if any(
        len(one.rows) > MOST_ROWS or max(len(cells) for _, cells in one.rows) > MOST_COLUMNS for one in sheets
    ):
        raise InputError(f"{path}: {TOO_MANY}")
    return sheets


def _held(rows: list[Row]) -> list[Row]:
    """Rows that hold something, and are no remark."""
    rows = [(line, _trimmed(cells)) for line, cells in rows]
    # A table may begin in the second column, below a title in the first one.
    places = [[n for n, cell in enumerate(cells) if cell] for _, cells in rows]
    first = min((filled[0] for filled in places if len(filled) > 1), default=0)
    rows = [
        (line, cells[min(first, *filled) :])
        for (line, cells), filled in zip(rows, places, strict=True)
        if filled
    ]
    return [(line, cells) for line, cells in rows if cells and not _REMARK.match(_first(cells))]


def build_cells(path: Path, rows: list[Row], notes: list[str]) -> Cells:
    """A table from its rows; a title above its line of names is left out."""
    rows, notes = list(rows), list(notes)
    while len(rows) > 2 and len(rows[0][1]) == 1 < max(len(cells) for _, cells in rows[1:]):
        notes.append(f"line {rows[0][0]} taken for a title: {rows[0][1][0]!r}")
        rows.pop(0)
    # A column without a name is called by its number.
    header = [name or f"column {place}" for place, name in enumerate(rows[0][1], start=1)]
    return Cells(
        path, header, _fitted(path, header, _drop_remarks(rows[1:], len(header), notes), notes), notes
    )


def _drop_remarks(rows: list[Row], size: int, notes: list[str]) -> list[Row]:
    """Rows without what stands beside the table, behind a column left empty, and begins with a word in each row."""
    beside = [cells[size:] for _, cells in rows if len(cells) > size]
    # A number beside the table may be a result whose name is missing: it is refused further on.
    if not beside or any(cells[0] or re.match(r"[-+]?[.,]?\d", _first(cells)) for cells in beside):
        return rows
    notes.append(f"beside the table, passed over: {', '.join(repr(_first(cells)) for cells in beside[:3])}")
    return [(line, cells[:size]) for line, cells in rows]


def _trimmed(cells: list[str]) -> list[str]:
    """Cells without needless blanks, up to the last that holds something, with one kind of minus before a number."""
    # Word processors write a minus sign or a dash for a hyphen; `float` takes neither.
    cells = [
        cell if isinstance(cell, Number) else re.sub(r"^[−–](?=[\d.,])", "-", " ".join(cell.split()))
        for cell in cells
    ]
    filled = [place for place, cell in enumerate(cells) if cell]
    return cells[: filled[-1] + 1] if filled else []


def _first(cells: list[str]) -> str:
    return next(cell for cell in cells if cell)


def _fitted(path: Path, header: list[str], rows: list[Row], notes: list[str]) -> list[Row]:
    """Rows filled up to the length of the header, which none may exceed."""
    for line, cells in rows:
        if len(cells) > len(header):
            mend = f"write a name above {cells[len(header)]!r}, or clear what is no result"
            if "columns separated by commas" in notes:
                mend = "if decimals are written with a comma, separate the columns with semicolons"
            raise UnreadNames(
                f"{path}, line {line}: {len(cells)} fields under {len(header)} column names; {mend}."
            )
    return [(line, cells + [""] * (len(header) - len(cells))) for line, cells in rows]


def _text(path: Path) -> tuple[list[Row], list[str]]:
    """Rows of a text file, parted at its tabs, semicolons or commas, and notes on how it was read."""
    text, notes = _decoded(path)
    lines = io.StringIO(text, newline="").readlines()
    # Before it is parsed, so that the page of `serve` refuses a long text at once.
    if sum(not line.isspace() for line in lines) > MOST_ROWS + MOST_REMARKS:
        raise InputError(f"{path}: {TOO_MANY}")
    # Comments and Excel's `sep=;` become blank lines, so that line numbers stay those of the file.
    lines = ["\n" if _REMARK.match(line) or re.match(r"sep=.\s*$", line, re.I) else line for line in lines]
    # Within quotes a comma is of a decimal or of running text, and parts no columns.
    unquoted = [re.sub(r'"[^"]*"', "", line) for line in lines if line.strip()]
    # Above the names there may be a title, in which anything stands.
    # A machine's export begins with lines that hold no separator; its line of frequencies shows it.
    told = [line for line in unquoted if len(re.findall(_FREQUENCY, line, re.IGNORECASE)) > 1]
    told = told or [line for line in unquoted[1:] if re.match(r"\W*fr[eé]q", line, re.IGNORECASE)]
    separator, name = next(
        (
            (mark, name)
            # Before the comma: where one of these parts the columns, commas are decimal.
            for mark, name in (("\t", "tabs"), (";", "semicolons"))
            if unquoted
            and (
                mark in unquoted[0]
                or any(mark in line for line in told)
                or sum(mark in line for line in unquoted) > len(unquoted) / 2
                or all(mark in line for line in unquoted[1:])
            )
        ),
        (",", "commas"),
    )
    # Strict: else a quote that nobody closed swallows the rest of the file into one cell.
    reader = csv.reader(lines, delimiter=separator, strict=True)
    try:
        rows = [(reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise InputError(f"{path}, line {reader.line_num}: not CSV ({error}); save it as CSV.") from None
    return rows, [f"columns separated by {name}", *notes]


def _decoded(path: Path) -> tuple[str, list[str]]:
    """The text of a file, UTF-8, UTF-16 or cp1252, and a note unless it is UTF-8; refuses what is no text."""
    data = path.read_bytes()
    # Excel's "Unicode text" is UTF-16. Its UTF-8 begins with a mark too, which `utf-8-sig` drops.
    codec = "utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    not_text = InputError(f"{path}: not text; give CSV, TSV or a workbook (XLSX, XLS, XLSB, ODS).")
    # A null stands in nearly every binary file, and in text only as UTF-16.
    if data.startswith(b"%PDF-") or (codec != "utf-16" and b"\0" in data):
        raise not_text
    notes = ["read as UTF-16"] if codec == "utf-16" else []
    try:
        text = data.decode(codec)
    except UnicodeDecodeError:
        # What Excel and testing machines write in the west of Europe; Latin-1 is a part of it.
        text = data.decode("cp1252", errors="replace")
        if "\ufffd" in text:
            raise InputError(f"{path}: neither UTF-8 nor Windows text (cp1252); save it as UTF-8.") from None
        notes = ["text read as Windows (cp1252), for it is not UTF-8"]
    if "\0" in text:
        raise not_text
    return text, notes


def _workbook(path: Path, sheet: str | None) -> list[Sheet]:
    """Sheets that are shown and hold something, or the one wanted, with the values that the spreadsheet stored.

    Nothing is evaluated, and no link to another workbook followed.
    """
    try:
        found, hidden = (_xlsx if _is_xlsx(path) else _other_workbook)(path, sheet)
    except InputError:
        raise
    except Exception as error:  # a damaged file raises nearly anything
        raise InputError(
            f"{path}: cannot be read as a workbook ({type(error).__name__}), or has a password; save it as XLSX or CSV "
            "without a password."
        ) from None
    if sheet is not None and sheet not in found:
        raise InputError(f"{path}: no sheet {sheet!r}; give one of {', '.join(found)}.")
    filled = {name: rows for name, (rows, _) in found.items() if any(any(cells) for _, cells in rows)}
    shown = [name for name in filled if name not in hidden] if sheet is None else [sheet]
    left_out = [f"hidden sheet {name} not read" for name in filled if name not in (*shown, sheet)]
    return [
        Sheet(path, name, rows, [f"sheet {name}", *(left_out if sheet is None else []), *found[name][1]])
        for name, rows in filled.items()
        if name in (shown or filled)
    ]


def _is_xlsx(path: Path) -> bool:
    """Whether a file is an archive with a workbook of Excel 2007; refuses one that unpacks to too much."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as archive:
        unpacked = sum(part.file_size for part in archive.infolist())
        if unpacked > MOST_UNPACKED:
            raise InputError(f"{path}: unpacks to {unpacked // 10**6} MB; give the table of results alone.")
        return {"mimetype", "xl/workbook.bin"}.isdisjoint(archive.namelist())


_Sheets = tuple[dict[str, tuple[list[Row], list[str]]], set[str]]  # rows and notes by sheet; which are hidden


def _xlsx(path: Path, wanted: str | None) -> _Sheets:
    """Sheets by openpyxl, which reads row by row: calamine takes room for each cell up to the last one, and aborts."""
    import openpyxl

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of drop-down lists and the like, which openpyxl passes over
        book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
        # A sheet that is only a chart has no rows. Of a sheet that is not wanted only the name is.
        sheets = {one.title: one if wanted in (None, one.title) else None for one in book.worksheets}
        found = {
            name: ([], []) if one is None else (_rows(one), _hidden_lines(path, one))
            for name, one in sheets.items()
        }
        hidden = {one.title for one in book.worksheets if one.sheet_state != "visible"}
        book.close()
    return found, hidden


def _rows(sheet: Any) -> list[Row]:
    # A format in a cell far away makes a sheet a million rows long; one row too many is enough to refuse it.
    rows = sheet.iter_rows(max_row=MOST_ROWS + 2, max_col=MOST_COLUMNS + 1, values_only=True)
    return [(line, [_cell(value) for value in cells]) for line, cells in enumerate(rows, start=1)]


def _hidden_lines(path: Path, sheet: Any) -> list[str]:
    """A note on the rows and columns of a sheet that are hidden, as by a filter; refuses values beyond MOST_ROWS."""
    # openpyxl knows them only of a sheet that it holds whole.
    with sheet._get_source() as file:
        xml = file.read()
    for row in re.finditer(rb'<row\b[^>]*?\br="(\d+)"[^>]*?(?<!/)>(.*?)</row>', xml, re.DOTALL):
        if int(row[1]) > MOST_ROWS and row[2].count(b"</c>") > 1:
            raise InputError(f"{path}: values in row {int(row[1])}; {TOO_MANY}")
    rows = [int(line) for line in re.findall(rb'<row\b(?=[^>]*\bhidden="(?:1|true)")[^>]*\br="(\d+)"', xml)]
    # Columns hidden side by side are one element.
    hidden = rb'<col\b(?=[^>]*\bhidden="(?:1|true)")(?=[^>]*\bmin="(\d+)")(?=[^>]*\bmax="(\d+)")'
    spans = [(int(first), min(int(last), MOST_COLUMNS)) for first, last in re.findall(hidden, xml)]
    columns = [number for first, last in spans for number in range(first, last + 1)]
    named = [f"rows {_listed(rows)}"] * bool(rows) + [f"columns {_listed(columns)}"] * bool(columns)
    return [f"hidden {' and '.join(named)} are read too; delete what shall not count"] if named else []


def _listed(numbers: Iterable[int]) -> str:
    texts = list(map(str, numbers))
    return ", ".join(texts[:8]) + (", ..." if len(texts) > 8 else "")


def _other_workbook(path: Path, wanted: str | None) -> _Sheets:
    """Sheets of an ODS, XLS or XLSB file."""
    import python_calamine

    if _has_far_cell(path):
        raise InputError(f"{path}: {TOO_MANY}")
    with python_calamine.load_workbook(path) as book:
        metadata = [one for one in book.sheets_metadata if one.typ == python_calamine.SheetTypeEnum.WorkSheet]
        found: dict[str, tuple[list[Row], list[str]]] = {}
        for name in (one.name for one in metadata):
            sheet = book.get_sheet_by_name(name) if wanted in (None, name) else None
            if sheet is not None and (
                sheet.total_height > 2 * MOST_ROWS or sheet.total_width > 4 * MOST_COLUMNS
            ):
                raise InputError(f"{path}: {TOO_MANY}")
            cells = [] if sheet is None else sheet.to_python(skip_empty_area=False)
            found[name] = [(line, [_cell(one) for one in row]) for line, row in enumerate(cells, start=1)], []
        hidden = {one.name for one in metadata if one.visible != python_calamine.SheetVisibleEnum.Visible}
    return found, hidden


def _has_far_cell(path: Path) -> bool:
    """Whether an XLSB file has a row or a cell beyond what is read, of which calamine aborts for want of room."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as archive:
        parts = [name for name in archive.namelist() if re.fullmatch(r"xl/worksheets/\w+\.bin", name)]
        return any(_is_far(archive.read(name)) for name in parts)


def _is_far(records: bytes) -> bool:
    """Whether a row (record of kind 0) or a cell (1 to 11) of a sheet stands beyond what is read ([MS-XLSB] 2.1.4)."""
    at = 0

    def number() -> int:
        """The next number of the records, 7 bits a byte, the lowest first; the top bit says that more follow."""
        nonlocal at
        value = shift = 0
        more = True
        while more and at < len(records):
            value |= (records[at] & 127) << shift
            more, at, shift = records[at] > 127, at + 1, shift + 7
        return value

    while at < len(records):
        kind, size = number(), number()
        place = int.from_bytes(records[at : at + 4], "little")
        if kind < 12 and place > (4 * MOST_COLUMNS if kind else 2 * MOST_ROWS):
            return True
        at += size
    return False


def _cell(value: object) -> str:
    if isinstance(value, int | float) and not isinstance(value, bool):
        return Number(value)
    return "" if value is None else str(value).strip()
