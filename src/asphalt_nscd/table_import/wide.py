"""Wide tables, a column for each temperature or each frequency: `|E*| (MPa) at 15 °C`, `phi (deg) 10 Hz`."""

from __future__ import annotations

import re

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.decimals import like_below
from asphalt_nscd.table_import.quantities import recognise

_LINK = r"(?P<name>.*?\S)(?:\s*(?:at|@|à|bei|,|;|[Tf]\s*=)\s*|[\s_]+)"
# What a name of a column may hold: the quantity it gives, the column for it, how it is written, its plural.
_CELSIUS = re.compile(_LINK + r"(?P<at>[-−]?\d+(?:[.,]\d+)?)\s*(?:[°º]\s*|deg\s?)?C")
_HERTZ = re.compile(_LINK + r"(?P<at>\d+(?:[.,]\d+)?)\s*Hz")
_SPREAD = (
    ("temperature_C", "T (°C)", _CELSIUS, "temperatures"),
    ("frequency_Hz", "f (Hz)", _HERTZ, "frequencies"),
)


def melted(cells: Cells) -> tuple[Cells, list[str]]:
    """One row for each test, where column names hold temperatures or frequencies; other tables as they are."""
    notes: list[str] = []
    for spread in _SPREAD:
        cells, said = _melted(cells, *spread)
        notes += said
    return cells, notes


def without_condition(name: str) -> str:
    """Name of a column without the temperature or the frequency that it holds."""
    found = [match["name"] for *_, pattern, _ in _SPREAD if (match := pattern.fullmatch(name))]
    return found[0] if found else name


def held_by_names(name: str) -> set[str]:
    """Which of temperature and frequency the name of a column holds."""
    return {quantity for quantity, _, pattern, _ in _SPREAD if pattern.fullmatch(name)}


def _melted(
    cells: Cells, quantity: str, column: str, pattern: re.Pattern[str], plural: str
) -> tuple[Cells, list[str]]:
    found = {place: match for place, name in enumerate(cells.header) if (match := pattern.fullmatch(name))}
    if not found:
        return cells, []
    spread: dict[float, dict[str, int]] = {}
    written: dict[float, str] = {}
    for place, match in found.items():
        text = match["at"].replace("−", "-")
        at = float(text.replace(",", "."))  # 10 and 10.0 are one
        written.setdefault(at, text)
        other = spread.setdefault(at, {}).setdefault(match["name"], place)
        if other != place:
            raise InputError(
                f"{cells.path}: columns {cells.header[other]!r} and {cells.header[place]!r} hold one quantity at one "
                "condition; keep one of the two, or write the other into rows of another specimen."
            )
    names = list(next(iter(spread.values())))
    shared = [place for place in range(len(cells.header)) if place not in found]
    plain = any((known := recognise(cells.header[place])) and known.quantity == quantity for place in shared)
    if plain or any(set(columns) != set(names) for columns in spread.values()):
        raise InputError(
            f"{cells.path}: {plural} stand in names of columns such as {cells.header[next(iter(found))]!r}, but "
            f"not the same for all quantities; give one row for each test, with a column {column}."
        )
    header = [*(cells.header[place] for place in shared), column, *names]
    below = [row[place] for _, row in cells.rows for place in found]
    rows = [
        (line, [*(row[place] for place in shared), like_below(written[at], below), *measured])
        for at, columns in spread.items()
        for line, row in cells.rows
        # What was not tested there is left empty.
        if any(measured := [row[columns[name]] for name in names])
    ]
    return Cells(cells.path, header, rows, cells.notes), [f"{plural} taken from the names of the columns"]
