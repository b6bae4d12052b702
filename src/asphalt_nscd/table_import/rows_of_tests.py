"""The layout that every other sheet has: a row for each test, or one for several whose headings say which."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from asphalt_nscd.files.words import choice
from asphalt_nscd.table_import.cells import Block, Cells, NotTests, Row, Sheet
from asphalt_nscd.table_import.decimals import number
from asphalt_nscd.table_import.header_lines import (
    add_constants,
    attach_units,
    require_rows,
    sections,
    tabulated,
)
from asphalt_nscd.table_import.heading import HERTZ, TEMPERATURES, condition, known, quantity_of
from asphalt_nscd.table_import.melt import held, holds_means
from asphalt_nscd.table_import.names import specimen_of
from asphalt_nscd.table_import.words import COMPUTED_SHEET

_TEMPERATURE = re.compile(
    r"(?:T\s*=?\s*)?([-−+]?\d+(?:[.,]\d+)?)\s*(?:[°º]\s*|deg\.?\s*)?([CF])", re.IGNORECASE
)


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
    return _told_by_sheet(attach_units(cells), sheet.called, chosen)


def is_computed_sheet(name: str, cells: Cells) -> bool:
    """Whether a sheet was computed from others: its name says so, and no column names specimens."""
    return bool(COMPUTED_SHEET.match(name)) and "specimen" not in held(cells)


def _told_by_sheet(cells: Cells, name: str, chosen: Mapping[str, str]) -> Cells:
    """The table with columns for specimen and temperature from the name of its sheet, if it has none."""
    has = held(cells) | set(map(quantity_of, chosen))
    bare, named = _TEMPERATURE.fullmatch(name), specimen_of(name, None)
    temperature = bare[1].replace("−", "-") if bare else named.temperature
    told: dict[str, str] = {}
    if has.isdisjoint(TEMPERATURES):
        if temperature:
            told[f"T (°{bare[2].upper() if bare else 'C'})"] = temperature
    elif temperature and not bare and not _all_at(cells, temperature):
        temperature = None  # a part of the specimen's own name
    if frequency := condition(name).get(HERTZ):
        told |= {} if "frequency_Hz" in has else {HERTZ: frequency}
    elif "specimen" not in has and not bare:
        told["specimen"] = named.specimen if temperature else name
    return add_constants(cells, told, "the name of the sheet")


def _all_at(cells: Cells, temperature: str) -> bool:
    """Whether every test is at one temperature, which is this one within a degree."""
    wanted = float(temperature.replace(",", "."))
    for place, name in enumerate(cells.header):
        if (column := known(name)) and column.quantity == "temperature_C":
            read = [value for _, row in cells.rows if (value := number(row[place])) is not None]
            return all(abs(value * column.factor + column.offset - wanted) < 1.0 for value in read)
    return False
