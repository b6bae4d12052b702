"""Files of sheets drawn, as XLSX, ODS and CSV, with the tests that they hold."""

from __future__ import annotations

import csv
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import openpyxl

from layouts.families import FAMILIES, Family
from layouts.laboratory import Laboratory, Rows, Sheets, Tests


def draw(seed: int, folder: Path) -> tuple[str, Path, Tests]:
    """A file with its tests, of a family by turns; which, where it lies and what it holds."""
    lab = Laboratory(seed)
    family, sheets = sheets_of(lab, seed)
    return family, save(folder, f"{family}_{seed}", sheets, lab), lab.tests


def sheets_of(lab: Laboratory, seed: int, families: Sequence[Family] = FAMILIES) -> tuple[str, Sheets]:
    """The family and the sheets of a laboratory."""
    family = families[seed % len(families)]
    sheets = family(lab)
    if lab.chance(0.25):  # begins in the second column
        sheets = {name: [[None, *row] for row in rows] for name, rows in sheets.items()}
    if lab.chance(0.25):
        title = [[lab.pick("Lot 7", "RN 86, PR 12", "Messung Mai", "Campaña 2021")], []]
        sheets = {name: [*title, *rows] for name, rows in sheets.items()}
    return family.__name__, sheets


def save(folder: Path, stem: str, sheets: Sheets, lab: Laboratory) -> Path:
    """Write sheets as a file of one of the formats that hold them."""
    endings = ["xlsx", "xlsx", "xlsx", "ods", "csv"] if len(sheets) == 1 else ["xlsx", "xlsx", "ods"]
    ending = lab.pick(endings)
    path = folder / f"{stem}.{ending}"
    {"xlsx": save_xlsx, "ods": save_ods, "csv": save_csv}[ending](path, sheets, lab)
    return path


def save_xlsx(path: Path, sheets: Sheets, lab: Laboratory) -> None:
    book = openpyxl.Workbook()
    book.remove(book.active)
    hide = lab.chance(0.1)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
        sheet.row_dimensions[len(rows)].hidden = hide
    book.save(path)


def save_csv(path: Path, sheets: Sheets, lab: Laboratory) -> None:
    """With semicolons and decimal commas where the language has them."""
    ((_, rows),) = sheets.items()
    english = lab.language == "en"

    def cell(value: Any) -> str:
        text = "" if value is None else str(value)
        return text if english or not isinstance(value, float) else text.replace(".", ",")

    encoding = lab.pick("utf-8", "utf-8-sig", "utf-16", "cp1252")
    try:
        str(rows).encode(encoding)
    except UnicodeEncodeError:
        encoding = "utf-8-sig"
    with path.open("w", newline="", encoding=encoding) as file:
        writer = csv.writer(file, delimiter="," if english else ";")
        writer.writerows([cell(value) for value in row] for row in rows)


def save_ods(path: Path, sheets: Sheets, lab: Laboratory) -> None:
    """As LibreOffice keeps it."""

    def cell(value: Any) -> str:
        if value is None:
            return "<table:table-cell/>"
        number = isinstance(value, int | float)
        kind = f'float" office:value="{value}' if number else "string"
        return f'<table:table-cell office:value-type="{kind}"><text:p>{escape(str(value))}</text:p></table:table-cell>'

    def table(name: str, rows: Rows) -> str:
        cells = ("".join(map(cell, row or [None])) for row in rows)
        lines = "".join(f"<table:table-row>{line}</table:table-row>" for line in cells)
        return f'<table:table table:name="{escape(name)}">{lines}</table:table>'

    urn = "urn:oasis:names:tc:opendocument:xmlns"
    names = "".join(f' xmlns:{n}="{urn}:{n}:1.0"' for n in ("office", "table", "text"))
    tables = "".join(table(name, rows) for name, rows in sheets.items())
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr("META-INF/manifest.xml", "<manifest/>")
        body = f"<office:body><office:spreadsheet>{tables}</office:spreadsheet></office:body>"
        whole = f'<office:document-content{names} office:version="1.2">{body}</office:document-content>'
        archive.writestr("content.xml", whole)
