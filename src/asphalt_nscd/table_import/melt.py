"""Wide tables: one row for each test, where headings say temperatures, frequencies or specimens."""

from __future__ import annotations

import re
from dataclasses import replace

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells
from asphalt_nscd.table_import.decimals import match_decimal_mark
from asphalt_nscd.table_import.heading import (
    CELSIUS,
    FAHRENHEIT,
    HERTZ,
    MEAN,
    SPECIMEN,
    Heading,
    is_spread,
    quantity_of,
    read_heading,
)
from asphalt_nscd.table_import.quantities import Meaning

_PLURALS = {CELSIUS: "temperatures", FAHRENHEIT: "temperatures", HERTZ: "frequencies", SPECIMEN: "specimens"}


def headings_of(cells: Cells) -> list[Heading]:
    """The headings of a table, one for each column, with what the lines above them say."""
    read = _replicates([read_heading(name) for name in cells.header])
    return [
        replace(one, at={**one.at, **at}) if one.is_result else one
        for one, at in zip(read, cells.at or [{}] * len(read), strict=True)
    ]


def _replicates(headings: list[Heading]) -> list[Heading]:
    """Headings in which E1 and E2 are |E*| of two specimens, where another is numbered too: E3, or phi1."""
    if not any(SPECIMEN in one.at for one in headings):
        return headings
    return [
        Heading(re.sub(r"^E[\s_]*[12]", "E", one.name), {SPECIMEN: found[1]})
        if (found := re.match(r"E[\s_]*([12])(?!\d)", one.name))
        else one
        for one in headings
    ]


def held(cells: Cells) -> set[str]:
    """Quantities, by our names, that the columns and their headings give."""
    headings = headings_of(cells)
    told = {name for one in headings for name, text in one.at.items() if text != MEAN}
    return {quantity_of(name) for name in told.union(one.name for one in headings)} - {""}


def holds_means(cells: Cells) -> bool:
    """Whether all results of a table are means; False without results."""
    results = [one for one in headings_of(cells) if one.is_result]
    return bool(results) and all(one.at.get(SPECIMEN) == MEAN for one in results)


def melted(cells: Cells) -> Cells:
    """One row for each test, where headings hold conditions; other tables as they are."""
    headings, notes = headings_of(cells), list(cells.notes)
    means = [n for n, one in enumerate(headings) if one.at.get(SPECIMEN) == MEAN]
    others = {one.quantity for one in headings if one.is_result and one.at.get(SPECIMEN) != MEAN}
    of_others = [n for n in means if headings[n].quantity in others]
    if not of_others and all(len(headings[n].at) == 1 for n in means):
        for n in means:  # means alone are the tests
            headings[n] = Heading(headings[n].name)
    spreads = [n for n, one in enumerate(headings) if one.left_out or is_spread(one.at.get(SPECIMEN, ""))]
    if left_out := sorted({*spreads, *of_others}):
        called = (f"{cells.header[n]} {headings[n].at.get(SPECIMEN, '')}".strip() for n in left_out[:6])
        notes.append(f"left out, means and deviations of other columns: {', '.join(map(repr, called))}")
    shared = [n for n, one in enumerate(headings) if n not in left_out and not one.at]
    spread = _grouped(cells, headings, left_out)
    if not spread:
        rows = [(line, [row[n] for n in shared]) for line, row in cells.rows]
        return Cells(cells.path, [headings[n].name for n in shared], rows, notes)
    _require_alike(cells, headings, shared, spread)
    _require_one_unit(cells, headings, spread)
    conditions = [key for key, _ in next(iter(spread))]
    names = {quantity: headings[n].name for quantity, n in next(iter(spread.values())).items()}
    below = [row[n] for _, row in cells.rows for group in spread.values() for n in group.values()]
    rows = []
    for columns in spread.values():
        at = headings[next(iter(columns.values()))].at
        # `0.5 Hz` in a heading may have a point above cells with decimal commas.
        texts = [at[key] if key == SPECIMEN else match_decimal_mark(at[key], below) for key in conditions]
        for line, row in cells.rows:
            measured = [row[columns[name]] for name in names]
            if any(measured):  # what was not tested there is left empty
                rows.append((line, [*(row[n] for n in shared), *texts, *measured]))
    header = [*(headings[n].name for n in shared), *conditions, *names.values()]
    notes += [f"{_PLURALS[key]} taken from the names of the columns" for key in conditions]
    return Cells(cells.path, header, rows, notes)


_Groups = dict[tuple[tuple[str, object], ...], dict[str, int]]


def _grouped(cells: Cells, headings: list[Heading], left_out: list[int]) -> _Groups:
    """Places of the columns with conditions, by these and then by quantity; refuses two that have both alike."""
    spread: _Groups = {}
    for n, heading in enumerate(headings):
        if not heading.at or n in left_out:
            continue
        other = spread.setdefault(_key(heading), {}).setdefault(heading.quantity, n)
        if other != n:
            raise InputError(
                f"{cells.path}: columns {cells.header[other]!r} and {cells.header[n]!r} hold one quantity at one "
                "condition; keep one of the two, or write the other into rows of another specimen."
            )
    return spread


def _key(heading: Heading) -> tuple[tuple[str, object], ...]:
    return tuple(
        (name, text if name == SPECIMEN else float(text.replace(",", ".")))  # 10 and 10.0 are one
        for name in _PLURALS
        if (text := heading.at.get(name))
    )


def _require_alike(cells: Cells, headings: list[Heading], shared: list[int], spread: _Groups) -> None:
    """Refuse headings whose conditions are not the same for all quantities."""
    key, first = next(iter(spread.items()))
    conditions = [name for name, _ in key]
    twice = {*_RESULTS, *map(quantity_of, conditions)}  # if a column without conditions has it too
    alike = all(
        set(group) == set(first) and [name for name, _ in key] == conditions for key, group in spread.items()
    )
    if alike and twice.isdisjoint(headings[n].quantity for n in shared):
        return
    name = cells.header[next(iter(first.values()))]
    raise InputError(
        f"{cells.path}: {_PLURALS[conditions[0]]} stand in names of columns such as {name!r}, but "
        f"not the same for all quantities; give one row for each test, with a column {conditions[0]}."
    )


def _require_one_unit(cells: Cells, headings: list[Heading], spread: _Groups) -> None:
    """Refuse two units of one quantity: below each other all its numbers stand under one name."""
    first: dict[str, tuple[int, Meaning]] = {}
    for quantity, n in (pair for columns in spread.values() for pair in columns.items()):
        own = headings[n].column
        if own is None or own.unit is None:
            continue
        other, told = first.setdefault(quantity, (n, own))
        if (own.factor, own.offset) != (told.factor, told.offset):
            raise InputError(
                f"{cells.path}: columns {cells.header[other]!r} and {cells.header[n]!r} hold one quantity in two "
                "units; give all in one unit."
            )


_RESULTS = ("E_MPa", "phase_deg", "E1_MPa", "E2_MPa", "tan_delta", "F0_N", "psi_deg")
