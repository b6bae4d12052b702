"""Which rows of a table are tests: not names that are repeated, remarks, means, nor what was not measured."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.table_import.cells import Cells, Row
from asphalt_nscd.table_import.header_lines import told_above
from asphalt_nscd.table_import.words import ABSENT, OF_SPECIMENS, pattern

# Columns in which merged cells leave all but the first cell empty.
CARRIED = ("mix", "specimen", "replicate", "nominal_temperature_C", "temperature_C")
_STATISTIC = pattern("mean", "spread", before=r"\W*", behind=r".*")
_BEGINS_NUMBER = re.compile(r"[-−+]?[.,]?\d")
_NAMES, _REMARK, _MEAN, _NOT_MEASURED = (
    "names of columns repeated",
    "no number of a test",
    "means and deviations of other lines",
    "neither modulus nor phase",
)


def tests_in(cells: Cells, places: Mapping[str, int], measured: Sequence[str]) -> Cells:
    """The rows that are tests, with what merged cells hold written into each; notes say what was left out."""
    keys = [places[name] for name in ("temperature_C", "frequency_Hz")]
    results = [places[name] for name in measured]
    labels = [places[name] for name in ("specimen", "replicate") if name in places]
    kept: list[Row] = []
    left: dict[str, list[Row]] = {}
    for line, row in cells.rows:
        # Tables that were pasted below each other bring their names again.
        why = _NAMES if row == cells.header else _rejection(row, keys, results)
        (kept if why is None else left.setdefault(why, [])).append((line, row))
    cells = _carried(replace(cells, rows=kept), places, CARRIED[:3])
    tests: list[Row] = []
    means: list[Row] = []
    for line, row in cells.rows:
        of_others = any(OF_SPECIMENS.fullmatch(row[place]) for place in labels)
        (means if of_others else tests).append((line, row))
    if means and tests:  # of a table of means alone, these are the tests
        left.setdefault(_MEAN, []).extend(means)
        cells = replace(cells, rows=tests)
    specimens = {row[place] for _, row in tests for place in labels}
    for line, row in (*left.get(_REMARK, []), *left.get(_NOT_MEASURED, [])):
        # A line that names another specimen begins a second table, which would be taken for more of the first. In front
        # of it stand the columns, three at most, that lines above the names gave.
        if any(set(told_above([(line, row[start:])])[0].values()) - specimens for start in range(4)):
            raise InputError(
                f"{cells.path}, line {line}: {' '.join(_filled(row))[:60]!r} stands among the tests; write it into a "
                "column of its own, or the names of the columns below it."
            )
    if not cells.rows:
        # A program that writes formulas stores no values, and openpyxl gives empty cells.
        names = " and ".join(repr(cells.header[place]) for place in results)
        raise InputError(
            f"{cells.path}: no line has a number in {names} (formulas that were not computed?); save the table with "
            "its values."
        )
    notes = [*cells.notes, *(f"left out, {why}: {_quoted(why, rows)}" for why, rows in left.items())]
    return _carried(replace(cells, notes=notes), places, CARRIED[3:])


def _rejection(row: list[str], keys: list[int], results: list[int]) -> str | None:
    """Why a row is no test; None if it is one, or should be."""
    if not any(_BEGINS_NUMBER.match(row[place]) for place in (*keys, *results)):
        return _NOT_MEASURED if any(row[place] for place in results) and len(_filled(row)) > 2 else _REMARK
    if not all(row[place] for place in keys) and _STATISTIC.fullmatch(_filled(row)[0]):
        return _MEAN
    if all(row[place].casefold() in ABSENT for place in results):
        return _NOT_MEASURED
    return None


def _filled(row: list[str]) -> list[str]:
    return [cell for cell in row if cell]


def _quoted(why: str, rows: list[Row]) -> str:
    lines = ", ".join(str(line) for line, _ in rows[:8]) + (", ..." if len(rows) > 8 else "")
    said = f"{'line' if len(rows) == 1 else 'lines'} {lines}"
    return f"{said} ({' '.join(_filled(rows[0][1]))[:60]!r})" if why == _REMARK else said


def _carried(cells: Cells, places: Mapping[str, int], names: Sequence[str]) -> Cells:
    """The table with the value above in empty cells of columns `names`; refused where that is not the only reading."""
    rows = [(line, list(row)) for line, row in cells.rows]
    notes = list(cells.notes)
    for place in (places[name] for name in names if name in places):
        given = [row[place] for _, row in rows]
        if all(given) or not given[0]:
            continue
        # Merged cells give a value once; a column that repeats it has gaps.
        merged = not any(a and a == b for a, b in zip(given, given[1:], strict=False))
        for n, (line, row) in enumerate(rows):
            below = next((value for value in given[n:] if value), None)
            above = rows[n - 1][1][place]
            if not merged and not row[place] and below != above and not OF_SPECIMENS.fullmatch(above):
                follows = f"between {above} and {below}" if below else "at the end"
                raise InputError(
                    f"{cells.path}, line {line}: {cells.header[place]} is empty {follows}; fill it in."
                )
            row[place] = row[place] or above
        empty = counted(sum(not value for value in given), "empty cell")
        notes.append(f"{cells.header[place]!r}: {empty} with the value above, as in merged cells")
    return replace(cells, rows=rows, notes=notes)
