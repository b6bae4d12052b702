"""Names of columns where they stand: below a preface, in two lines with merged cells, units below them or in cells."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells, NotTests, Row
from asphalt_nscd.table_import.quantities import MEASURED, Column, is_unit, recognise, unit_in
from asphalt_nscd.table_import.wide import without_condition

MOST_ABOVE = 100  # lines in which the names are sought
_ONE_TEMPERATURE = 3.0  # K between readings of one target, in any unit
_CONDITION = re.compile(
    r"(?:[A-Za-zéü.]+\s*[=:]?\s*)?([-−]?\d+(?:[.,]\d+)?)\s*((?:[°º]\s*|deg\.?\s*)?C|Hz)", re.IGNORECASE
)
_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?")
_WITH_UNIT = re.compile(r"([-−+]?\d*[.,]?\d+(?:[eE][-+]?\d+)?)\s*([^\d\s.,].*)")
_NO_UNIT = ("", "-", "–", "—", "1", "[-]", "(-)", "[ ]", "[1]")


def headed(rows: list[Row], notes: list[str]) -> list[Row]:
    """Rows from the line of names on, which is one line even where the user's is two; the notes say what was done.

    Rows in whose lines no quantities are named stay as they are.
    """
    at = next((n for n, (_, cells) in enumerate(rows[:MOST_ABOVE]) if _names(cells)), None)
    if at is None:
        return rows
    line, names = rows[at]
    below = rows[at + 1][1] if at + 1 < len(rows) else []
    above = rows[at - 1][1] if at else []
    if below and all(_CONDITION.fullmatch(cell) for cell in below if cell):
        notes.append(f"names of columns from lines {line} and {rows[at + 1][0]}")
        joined, first, last = _joined(_filled(names, len(below)), below), at, at + 2
    elif conditions := _conditions(above, names):
        notes.append(f"names of columns from lines {rows[at - 1][0]} and {line}")
        # A name that goes over both lines stands in the upper one.
        both = [low or (above[n] if n < len(above) else "") for n, low in enumerate(names)]
        joined, first, last = _joined(both, conditions), at - 1, at + 1
    else:
        joined, first, last = names, at, at + 1
    if first > 1 or (first and len(rows[0][1]) > 1):  # one cell alone is a title
        quoted = ", ".join(repr(cells[0] or next(filter(None, cells))) for _, cells in rows[: min(first, 3)])
        more = ", ..." if first > 3 else ""
        notes.append(f"{'lines' if first > 1 else 'line'} above the names passed over: {quoted}{more}")
        return [(line, joined), *rows[last:]]
    return [*rows[:first], (line, joined), *rows[last:]]


def require_rows(path: Path, rows: list[Row]) -> None:
    """Refuse a table with a column for each test; a machine's export has such columns, but one temperature in all."""
    held = {column.quantity: cells[1:] for _, cells in rows if (column := _known(cells[0]))}
    sizes = {len(held.get(name, [])) for name in ("temperature_C", "frequency_Hz", "E_MPa")}
    if len(sizes) > 1 or max(sizes) < 2:
        return
    read = [float(cell.replace(",", ".")) for cell in held["temperature_C"] if _NUMBER.fullmatch(cell)]
    if read and max(read) - min(read) > _ONE_TEMPERATURE:
        raise InputError(
            f"{path}: each test has a column; turn the table so that each test has a row (copy, paste transposed)."
        )


def _names(cells: list[str]) -> bool:
    """Whether a line names two measured quantities, and holds no number."""
    held = {column.quantity for cell in cells if (column := _known(cell)) and MEASURED[column.quantity][1]}
    return len(held) > 1 and not any(_NUMBER.fullmatch(cell) for cell in cells)


def _known(cell: str) -> Column | None:
    try:
        return recognise(without_condition(cell)) if cell else None
    except InputError:  # a unit of another quantity: `understand` refuses it
        return None


def _conditions(cells: list[str], names: list[str]) -> list[str]:
    """Temperatures or frequencies that merged cells hold above names; none if more than these stands there."""
    unit = ""
    out: list[str] = []
    for place, cell in enumerate(cells):
        found = _CONDITION.fullmatch(cell)
        column = None if found or not cell else _known(cell)
        if found:
            out.append(f"{found[1]} {found[2]}")
        elif column and not unit and column.unit in ("C", "Hz"):
            unit = column.unit  # `Temperature (°C)` in front of 4, 20, 37
            out.append("")
        elif unit and _NUMBER.fullmatch(cell):
            out.append(f"{cell} {unit}")
        elif cell and place < len(names) and names[place]:
            return []
        else:
            out.append(out[-1] if out and not cell else "")
    if not any(out):
        return []
    return [*out, *[out[-1]] * (len(names) - len(out))]


def _filled(names: list[str], size: int) -> list[str]:
    """Names with each carried on over the empty cells behind it."""
    out: list[str] = []
    for name in [*names, *[""] * (size - len(names))]:
        out.append(name or (out[-1] if out else ""))
    return out


def _joined(names: list[str], conditions: list[str]) -> list[str]:
    """`E (MPa)` and `4 °C` are `E (MPa) at 4 °C`."""
    size = max(len(names), len(conditions))
    pairs = zip(
        [*names, *[""] * (size - len(names))], [*conditions, *[""] * (size - len(conditions))], strict=True
    )
    out = []
    for name, condition in pairs:
        found = _CONDITION.fullmatch(condition)
        out.append(f"{name} at {found[1]} {found[2]}" if name and found else name)
    return out


def with_units(cells: Cells) -> Cells:
    """Units in a line of their own below the names, or behind the numbers of a column, are put behind the names."""
    if not cells.rows:
        raise NotTests(f"{cells.path}: no line below the names of columns; add a line for each test.")
    return _with_units_of_cells(_with_line_of_units(cells))


def _with_line_of_units(cells: Cells) -> Cells:
    line, units = cells.rows[0]
    told = [place for place, unit in enumerate(units) if unit not in _NO_UNIT and is_unit(unit)]
    other = [unit for unit in units if unit not in _NO_UNIT and not is_unit(unit)]
    if not told or (other and len(told) < 3) or any(re.search(r"\d", unit) for unit in other):
        return cells
    header = list(cells.header)
    for place in told:
        name, unit = header[place], units[place].strip("()[]{} ")
        if unit_in(name) is None:
            header[place] = f"{name} ({unit})"
        elif unit_in(f"x ({unit})") != unit_in(name):
            raise InputError(
                f"{cells.path}, line {line}: the unit {unit!r} below column {name!r} is another; correct one of them."
            )
    if len(cells.rows) == 1:
        raise InputError(f"{cells.path}: no line with numbers; add a line for each test.")
    return replace(cells, header=header, rows=cells.rows[1:], notes=[*cells.notes, f"units from line {line}"])


def _with_units_of_cells(cells: Cells) -> Cells:
    """`4 °C`, `10 Hz`: the unit goes to the name of the column, if every number of the column has the same."""
    header, rows, notes = list(cells.header), [list(row) for _, row in cells.rows], list(cells.notes)
    for place, name in enumerate(cells.header):
        column = _known(name)
        if column is None or not MEASURED[column.quantity][1]:
            continue
        found = {
            n: m for n, row in enumerate(rows) if (m := _WITH_UNIT.fullmatch(row[place])) and is_unit(m[2])
        }
        if not found:
            continue
        units = {unit_in(f"x ({match[2]})") for match in found.values()}
        bare = any(_NUMBER.fullmatch(row[place]) for row in rows)
        own = unit_in(without_condition(name))
        if len(units) > 1 or (own is not None and units != {own}) or (own is None and bare):
            n = next(iter(found))
            raise InputError(
                f"{cells.path}, line {cells.rows[n][0]}: {name}: {rows[n][place]!r} has a unit that the column or "
                "other cells have not; give all of them in one unit, and write it into the name of the column."
            )
        for n, match in found.items():
            rows[n][place] = match[1]
        if own is None:
            header[place] = f"{name} ({next(iter(found.values()))[2]})"
        notes.append(f"unit of {name!r} taken from its cells")
    numbered = [(line, row) for (line, _), row in zip(cells.rows, rows, strict=True)]
    return Cells(cells.path, header, numbered, notes)
