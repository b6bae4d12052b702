"""Where the names of columns stand: below a preface, in several lines with merged cells, units below or in cells."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells, NotTests, Row, build_cells
from asphalt_nscd.table_import.heading import (
    CELSIUS,
    FAHRENHEIT,
    HERTZ,
    KEYS,
    LABELS,
    SPECIMEN,
    condition,
    known,
    quantity_of,
    read_heading,
    strip_conditions,
)
from asphalt_nscd.table_import.quantities import MEASURED, is_unit, unit_in

MOST_ABOVE = 100  # lines in which the names are sought
MOST_LINES = 3  # of names, above or below the first
LONGEST_LABEL = 24  # characters of what tells specimens
_ONE_TEMPERATURE = 3.0  # K between readings of one target, in any unit
NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?")
_WITH_UNIT = re.compile(r"([-−+]?\d*[.,]?\d+(?:[eE][-+]?\d+)?)\s*([^\d\s.,].*)")
_NO_UNIT = ("", "-", "–", "—", "1", "[-]", "(-)", "[ ]", "[1]")
_AXES = {"C": CELSIUS, "F": FAHRENHEIT, "Hz": HERTZ}  # by the unit of the label in front of bare numbers


@dataclass(frozen=True)
class _Stack:
    """Lines from first up to last that name columns: their names, and the conditions of each."""

    first: int
    last: int
    names: list[str]
    at: list[dict[str, str]]


def tabulated(path: Path, rows: list[Row], notes: list[str]) -> Cells:
    """The table in rows of a sheet; names of columns over several lines become one line."""
    notes = list(notes)
    stack = _stack(rows)
    if stack is None:
        return build_cells(path, rows, notes)
    first, names_line = stack.first, rows[stack.last - 1][0]
    lines = [line for line, _ in rows[first : stack.last]]
    if len(lines) > 1:
        notes.append(f"names of columns from lines {', '.join(map(str, lines[:-1]))} and {lines[-1]}")
    told, used = told_above(rows[:first])
    passed = [row for n, row in enumerate(rows[:first]) if n not in used]
    body = rows[stack.last :]
    kept: list[Row] = []
    if len(passed) > 1 or (passed and (len(passed[0][1]) > 1 or used)):  # one cell alone is a title
        quoted = ", ".join(repr(next(filter(None, cells))) for _, cells in passed[:3])
        more = ", ..." if len(passed) > 3 else ""
        notes.append(f"{'lines' if len(passed) > 1 else 'line'} above the names passed over: {quoted}{more}")
    else:
        kept = passed
    cells = build_cells(path, [*kept, (names_line, stack.names), *body], notes)
    # Before constants stand in the line of units too.
    cells = _attach_unit_line(cells) if cells.rows else cells
    at = stack.at + [{}] * (len(cells.header) - len(stack.at))
    return add_constants(replace(cells, at=at if any(at) else None), told, "the lines above the names")


def add_constants(cells: Cells, told: dict[str, str], whence: str) -> Cells:
    """The table with a column for each thing in `told` (by our names) that no column gives; `whence` is for a note."""
    from asphalt_nscd.table_import.melt import held

    has = held(cells)
    new = {name: text for name, text in told.items() if quantity_of(name) not in ("", *has)}
    if not new:
        return cells
    said = " and ".join("temperature" if name.startswith("T ") else name for name in new)
    return replace(
        cells,
        header=[*new, *cells.header],
        rows=[(line, [*new.values(), *row]) for line, row in cells.rows],
        notes=[*cells.notes, f"{said} from {whence}"],
        at=None if cells.at is None else [*({} for _ in new), *cells.at],
    )


def told_above(rows: Sequence[Row]) -> tuple[dict[str, str], set[int]]:
    """What lines above a table say of all its tests, `T = 4 °C`, by our names, and which lines say it."""
    told: dict[str, str] = {}
    used: set[int] = set()
    for n, (_, cells) in enumerate(rows):
        filled = [cell for cell in cells if cell]
        found = condition(filled[0]) if len(filled) == 1 else {}
        pairs = list(zip(filled[::2], filled[1::2], strict=False))
        if len(filled) == 1 and (split := re.fullmatch(r"([^:=]+?)\s*[:=]\s*(\S.*)", filled[0])):
            pairs = [(split[1], split[2])]
        for label, value in pairs:
            column = known(label.rstrip(" :="))
            if column is None:
                continue
            if column.quantity in (SPECIMEN, "mix"):
                found[column.quantity] = value
            elif column.quantity in KEYS and NUMBER.fullmatch(value):
                found |= {_AXES.get(column.unit or "", label.rstrip(" :=")): value}
            elif column.quantity in KEYS:
                found |= condition(value)
        if found:
            told |= {name: text for name, text in found.items() if name not in told}
            used.add(n)
    return told, used


def sections(rows: list[Row]) -> list[list[Row]]:
    """Rows of a sheet, parted before lines that say specimen or temperature and, below that, name the columns anew."""
    starts = [0]
    named = [n for n, (_, cells) in enumerate(rows) if _names(cells)]
    for n in (n for n in named[1:] if n - 1 not in named):  # names may go over two lines
        above = n
        for start in range(max(n - MOST_LINES, starts[-1] + 1), n):
            if told_above([rows[start]])[1] and not any(map(NUMBER.fullmatch, rows[start + 1][1])):
                above = start
                break
        if above < n and (above - 1) not in named:
            starts.append(above)
    if len(starts) > 1 and named and not told_above(rows[: named[0]])[0]:
        return [rows]
    return [rows[a:b] for a, b in zip(starts, [*starts[1:], len(rows)], strict=True)]


def require_rows(path: Path, rows: list[Row]) -> None:
    """Refuse a table with a column for each test, except a machine's export, which has one temperature in all."""
    cells_of = {read_heading(cells[0]).quantity: cells[1:] for _, cells in rows}
    sizes = {len(cells_of.get(name, [])) for name in ("temperature_C", "frequency_Hz", "E_MPa")}
    if len(sizes) > 1 or max(sizes) < 2:
        return
    read = [float(cell.replace(",", ".")) for cell in cells_of["temperature_C"] if NUMBER.fullmatch(cell)]
    if read and max(read) - min(read) > _ONE_TEMPERATURE:
        raise InputError(
            f"{path}: each test has a column; turn the table so that each test has a row (copy, paste transposed)."
        )


def _names(cells: list[str]) -> bool:
    """Whether a line names two measured quantities, and holds no number."""
    measured = {read_heading(cell).quantity for cell in cells} - {"", *LABELS}
    return len(measured) > 1 and not any(map(NUMBER.fullmatch, cells))


def _add_keys_below(names: list[str], cells: list[str]) -> list[str]:
    """Names of columns, with those of temperature, frequency and specimen that stand in `cells`, a line deeper."""
    if not _results(names):
        return names
    first = next(n for n, name in enumerate(names) if name and read_heading(name).is_result)
    deeper = [
        name or (cell if quantity_of(cell) in (*KEYS, *LABELS) else "")
        for name, cell in zip(names[:first], cells, strict=False)
    ]
    return deeper + names[len(deeper) :]


def _results(cells: list[str]) -> list[str]:
    """The cells of a line that name results; none of a line that holds a number."""
    return (
        [] if any(map(NUMBER.fullmatch, cells)) else [cell for cell in cells if read_heading(cell).is_result]
    )


def _stack(rows: list[Row]) -> _Stack | None:
    """The lines that name columns; None where no line names quantities."""
    at = next((n for n, (_, cells) in enumerate(rows[:MOST_ABOVE]) if _names(cells)), None)
    if at is None:
        return None
    if not _results(rows[at][1]) and at + 1 < len(rows) and len(_results(rows[at + 1][1])) > 1:
        at += 1  # temperature and frequency go down from the line above
    names = rows[at][1]
    first, last = at, at + 1
    below: list[list[str]] = []
    if last < len(rows):
        names = _add_keys_below(names, rows[last][1])
    while last < len(rows) and len(below) < MOST_LINES and _labels_below(rows[last][1], names):
        below.append(rows[last][1])
        last += 1
    size = max(map(len, [names, *below]))
    filled = _filled(names, size) if below else [*names]
    said: list[dict[str, str]] = [{} for _ in filled]
    for cells in below:
        row = cells if cells is below[-1] else _filled(cells, size)
        for n, text in enumerate([*row, *[""] * (size - len(row))]):
            named = text == filled[n] or _is_unit_of(text, filled[n])
            said[n] |= (condition(text) or {SPECIMEN: text}) if text and not named else {}
    while first and at - first < MOST_LINES:
        above = rows[first - 1][1]
        conditions = _labels_above(above, filled)
        if conditions is None:
            break
        # A name that goes over both lines stands in the upper one.
        filled = [name or (above[n] if n < len(above) else "") for n, name in enumerate(filled)]
        for n, more in enumerate(conditions[: len(filled)]):
            # The line nearer to the numbers wins.
            said[n] = more | said[n]
        first -= 1
    return _Stack(first, last, filled, [_alone(one, said) for one in said])


def _alone(one: dict[str, str], said: list[dict[str, str]]) -> dict[str, str]:
    """Conditions of a column, without a text for its specimen that all columns have: it tells none apart."""
    texts = {other[SPECIMEN] for other in said if SPECIMEN in other}
    named = len(texts) > 1 or any(SPECIMEN in condition(text) for text in texts)
    return one if named else {key: text for key, text in one.items() if key != SPECIMEN}


def _labels_below(cells: list[str], names: list[str]) -> bool:
    """Whether a line below names says for which condition or specimen each column is."""
    quantities = [read_heading(name).quantity for name in names]
    keys = {n for n, one in enumerate(quantities) if one in (*KEYS, SPECIMEN)}
    has_axis = not set(KEYS).isdisjoint(quantities)
    first = next((n for n, name in enumerate(names) if read_heading(name).is_result), 0)
    filled = [(n, cell) for n, cell in enumerate(cells) if cell]
    carried = _filled(names, len(cells))
    units = [_is_unit_of(cell, carried[n]) for n, cell in filled]
    # Three units make a line of units, whatever stands beside them.
    if len(filled) < 2 or all(units) or (sum(units) > 2 and any(n in keys for n, _ in filled)):
        return False
    if any(n in keys and not is_unit(cell) and cell != names[n] for n, cell in filled):
        return False
    return all(
        _is_unit_of(cell, carried[n])
        or (n in keys and cell == names[n])
        or condition(cell)
        or (
            n >= first and len(cell) <= LONGEST_LABEL and (has_axis if NUMBER.fullmatch(cell) else bool(keys))
        )
        for n, cell in filled
    )


def _is_unit_of(cell: str, name: str) -> bool:
    """Whether a cell is a unit of the quantity above it: below |E*|, C is a specimen."""
    column = read_heading(name).column
    return is_unit(cell) and (
        column is None or unit_in(f"x ({cell.strip('()[]{} ')})") in MEASURED[column.quantity][1]
    )


def _labels_above(cells: list[str], names: list[str]) -> list[dict[str, str]] | None:
    """By column, condition or specimen that merged cells hold above names; None if anything else stands there."""
    results = [one.quantity for one in map(read_heading, names) if one.is_result]
    several = len(results) > len(set(results))
    axis = ""
    out: list[dict[str, str]] = []
    for place, cell in enumerate(cells):
        below = names[place] if place < len(names) else ""
        column = known(cell)
        if not cell:
            out.append(out[-1] if out else {})
        elif found := condition(cell):
            out.append(found)
        elif column and not axis and column.unit in _AXES and below:
            axis = _AXES[column.unit]  # `Temperature (°C)` in front of 4, 20, 37
            out.append({})
        elif axis and NUMBER.fullmatch(cell):
            out.append({axis: cell})
        elif not below:
            out.append({})  # a name that goes over both lines
        elif (
            several
            and read_heading(below).is_result
            and len(cell) <= LONGEST_LABEL
            and len(list(filter(None, cells))) > 1
        ):
            out.append({SPECIMEN: cell})
        else:
            return None
    if not any(out):
        return None
    return [*out, *[out[-1]] * (len(names) - len(out))]


def _filled(names: list[str], size: int) -> list[str]:
    """Names with each carried on over the empty cells behind it."""
    out: list[str] = []
    for name in [*names, *[""] * (size - len(names))]:
        out.append(name or (out[-1] if out else ""))
    return out


def attach_units(cells: Cells) -> Cells:
    """Put units from a line below the names, or behind a column's numbers, behind the names of the columns."""
    if not cells.rows:
        raise NotTests(f"{cells.path}: no line below the names of columns; add a line for each test.")
    return _attach_cell_units(_attach_unit_line(cells))


def _attach_unit_line(cells: Cells) -> Cells:
    """The table without a line of units, which are put behind the names above; as it is if it has no such line."""
    line, units = cells.rows[0]
    told = [place for place, unit in enumerate(units) if unit not in _NO_UNIT and is_unit(unit)]
    other = [unit for unit in units if unit not in _NO_UNIT and not is_unit(unit)]
    # C, F, K and N are names of specimens too: beside other words it takes three units to make a line of units.
    if not told or (other and len(told) < 3) or any(re.match(r"[^A-Za-z]*\d", unit) for unit in other):
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


def _attach_cell_units(cells: Cells) -> Cells:
    """`4 °C`, `10 Hz`: the unit goes to the name of the column, if every number of the column has the same."""
    header, rows, notes = list(cells.header), [list(row) for _, row in cells.rows], list(cells.notes)
    for place, name in enumerate(cells.header):
        column = read_heading(name).column
        if column is None or not MEASURED[column.quantity][1]:
            continue
        found = {
            n: m for n, row in enumerate(rows) if (m := _WITH_UNIT.fullmatch(row[place])) and is_unit(m[2])
        }
        if not found:
            continue
        units = {unit_in(f"x ({match[2]})") for match in found.values()}
        bare = any(NUMBER.fullmatch(row[place]) for row in rows)
        own = unit_in(strip_conditions(name))
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
    return replace(cells, header=header, rows=numbered, notes=notes)
