"""The layout that every other sheet has: a row for each test, or one for several whose headings say which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from asphalt_nscd.files.words import choice
from asphalt_nscd.table_import.blocks import Block
from asphalt_nscd.table_import.cells import Cells, NotTests, Row, Sheet
from asphalt_nscd.table_import.header_lines import attach_units, require_rows, sections, tabulated
from asphalt_nscd.table_import.melt import holds_means
from asphalt_nscd.table_import.sheets import is_computed_sheet, told_by_sheet


def matches(sheets: Sequence[Sheet]) -> bool:
    """Whether it is one sheet."""
    return len(sheets) == 1


def read(sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Block]:
    """The tables of a sheet; beside other sheets its name may say their specimen and temperature."""
    (sheet,) = sheets
    require_rows(sheet.path, sheet.rows)
    tables = [_table(sheet, rows, chosen) for rows in sections(sheet.rows)]
    return [Block(table, means=holds_means(table)) for table in tables]


def _table(sheet: Sheet, rows: list[Row], chosen: Mapping[str, str]) -> Cells:
    """A table, with what the name of its sheet says of it."""
    cells = tabulated(sheet.path, rows, sheet.notes)
    if sheet.alone:
        return cells
    if is_computed_sheet(sheet.called, cells):
        way = choice("with --sheet", "alone")
        raise NotTests(
            f"{sheet.path}: its name says that it was computed of others; give it {way} if it holds tests."
        )
    # Units first: a column that the name of the sheet fills would be a number in their line.
    return told_by_sheet(attach_units(cells), sheet.called, chosen)
