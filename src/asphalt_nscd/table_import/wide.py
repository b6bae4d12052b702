"""Wide tables, with a column for each temperature: `|E*| (MPa) at 15 °C`, `phi (deg) -10°C`."""

from __future__ import annotations

import re

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.quantities import recognise

_AT = re.compile(
    r"(?P<name>.*?\S)(?:\s*(?:at|@|à|bei|,|;|T\s*=)\s*|[\s_]+)(?P<at>[-−]?\d+(?:[.,]\d+)?)\s*(?:[°º]\s*|deg\s?)?C"
)


def melted(cells: Cells) -> tuple[Cells, list[str]]:
    """One row for each temperature, where column names hold temperatures; other tables as they are."""
    found = {place: match for place, name in enumerate(cells.header) if (match := _AT.fullmatch(name))}
    if not found:
        return cells, []
    temperatures: dict[str, dict[str, int]] = {}
    for place, match in found.items():
        at = match["at"].replace("−", "-")
        if temperatures.setdefault(at, {}).setdefault(match["name"], place) != place:
            raise InputError(
                f"{cells.path}: column {cells.header[place]!r} stands twice; keep one of the two."
            )
    names = list(next(iter(temperatures.values())))
    shared = [place for place in range(len(cells.header)) if place not in found]
    plain = any(
        (column := recognise(cells.header[place])) and column.quantity == "temperature_C" for place in shared
    )
    if plain or any(set(columns) != set(names) for columns in temperatures.values()):
        raise InputError(
            f"{cells.path}: temperatures stand in names of columns such as {cells.header[next(iter(found))]!r}, but "
            "not alike for all quantities; give one row for each test, with a column T (°C)."
        )
    header = [*(cells.header[place] for place in shared), "T (°C)", *names]
    rows = [
        (line, [*(row[place] for place in shared), at, *measured])
        for at, columns in temperatures.items()
        for line, row in cells.rows
        # A temperature at which this frequency was not tested is left empty.
        if any(measured := [row[columns[name]] for name in names])
    ]
    return Cells(cells.path, header, rows, cells.notes), ["temperatures taken from the names of the columns"]
