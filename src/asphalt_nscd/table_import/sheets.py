"""What the name of a sheet says of the tests in it, where a workbook has a sheet for each specimen or temperature."""

from __future__ import annotations

import re
from collections.abc import Mapping

from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.decimals import number
from asphalt_nscd.table_import.header_lines import add_constants
from asphalt_nscd.table_import.melt import held
from asphalt_nscd.table_import.names import specimen_of
from asphalt_nscd.table_import.quantities import recognise
from asphalt_nscd.table_import.words import COMPUTED_SHEET

_TEMPERATURE = re.compile(
    r"(?:T\s*=?\s*)?([-−+]?\d+(?:[.,]\d+)?)\s*(?:[°º]\s*|deg\.?\s*)?([CF])", re.IGNORECASE
)


def is_computed_sheet(name: str, cells: Cells) -> bool:
    """Whether a sheet was computed from others: its name says so, and no column names specimens."""
    return bool(COMPUTED_SHEET.match(name)) and "specimen" not in held(cells)


def told_by_sheet(cells: Cells, name: str, chosen: Mapping[str, str]) -> Cells:
    """The table with columns for specimen and temperature from the name of its sheet, if it has none."""
    has = held(cells) | {column.quantity for wanted in chosen if (column := recognise(wanted))}
    bare, known = _TEMPERATURE.fullmatch(name), specimen_of(name, None)
    temperature = bare[1].replace("−", "-") if bare else known.temperature
    told: dict[str, str] = {}
    if has.isdisjoint({"temperature_C", "nominal_temperature_C"}):
        if temperature:
            told[f"T (°{bare[2].upper() if bare else 'C'})"] = temperature
    elif temperature and not bare and not _all_at(cells, temperature):
        temperature = None  # a part of the specimen's own name
    if "specimen" not in has and not bare:
        told["specimen"] = known.specimen if temperature else name
    return add_constants(cells, told, "the name of the sheet")


def _all_at(cells: Cells, temperature: str) -> bool:
    """Whether every test is at one temperature, which is this one within a degree."""
    wanted = float(temperature.replace(",", "."))
    for place, name in enumerate(cells.header):
        column = recognise(name)
        if column is not None and column.quantity == "temperature_C":
            read = [number(row[place]) for _, row in cells.rows]
            return all(
                value is None or abs(value * column.factor + column.offset - wanted) < 1.0 for value in read
            )
    return False
