"""Sweeps of shear rheometers: read as tables of a mix are, G in the names of columns taken for E."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from asphalt_nscd.files.csvinput import Table, Values
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.rheometer import COLUMNS, WANTED
from asphalt_nscd.table_import import rows_of_tests
from asphalt_nscd.table_import.cells import Cells, NotTests, Row, Sheet, read_sheets
from asphalt_nscd.table_import.decimals import number
from asphalt_nscd.table_import.header_lines import attach_units
from asphalt_nscd.table_import.heading import known
from asphalt_nscd.table_import.understand import understand

_SHEAR = re.compile(r"\bshear[\s_]+(?=\w*[\s_]*modul)|schub(?=modul)|\s+de cisaillement\b", re.IGNORECASE)
_LETTER = re.compile(r"(?<![^\W_])G(?=\s*(?:[|*'’′″\"]|[_([]|[12]\b|$))")
_YOUNG = re.compile(_LETTER.pattern.replace("G", "E"))
_LEAST_NUMBERS = 3  # of a line of results
_POINT = "point"  # a column of our own: each line is one, also where a test was repeated


def is_shear(name: str) -> bool:
    """Whether a name of a column is that of a shear modulus.

    >>> [is_shear(name) for name in ("|G*| (Pa)", "Complex Shear Modulus", "E* (MPa)", "Shear Strain")]
    [True, True, False, False]
    """
    return bool(_SHEAR.search(name) or (_LETTER.search(name) and known(_mix_name(name)) is not None))


def read_sweeps(path: Path) -> Table:
    """Temperature, frequency, |G*| and phase of each point in a file of a rheometer, under the names of COLUMNS.

    Its words are first changed into those of a mix (G to E), so that the reader of mixes reads it; a refusal changes
    them back.
    """
    names: dict[str, str] = {}  # of the file by those of a mix; `_renamed` enters them
    tables: list[Table] = []
    refused: list[NotTests] = []
    try:
        for sheet in read_sheets(path):
            for block in _blocks(replace(sheet, rows=_renamed(sheet.rows, names))):
                try:
                    tables += _tables(block)
                except NotTests as error:
                    refused.append(error)
        if not tables:
            raise refused[0]
    except InputError as error:
        raise InputError(_refusal(str(error), str(path), names)) from None
    ours = dict(zip(COLUMNS, ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg"), strict=True))
    joined: dict[str, Values] = {
        name: np.concatenate([table.numbers(of) for table in tables]) for name, of in ours.items()
    }
    return Table(path, joined, [line for table in tables for line in table.lines])


def _renamed(rows: list[Row], names: dict[str, str]) -> list[Row]:
    """Rows with the words of a mix in place of those of a binder; `names` collects what each stands for."""
    renamed = []
    for line, cells in rows:
        if any(_YOUNG.match(cell.strip("|")) and known(cell) for cell in cells):
            raise InputError(f", line {line}: names Young's modulus, and a binder's is in shear; {WANTED}.")
        ours = [cell if number(cell) is not None else _mix_name(cell) for cell in cells]
        names |= {new: old for new, old in zip(ours, cells, strict=True) if new != old}
        renamed.append((line, ours))
    return renamed


def _mix_name(name: str) -> str:
    """`E* (Pa)` for `G* (Pa)`, `Complex Modulus` for `Complex Shear Modulus`."""
    name = _LETTER.sub("E", _SHEAR.sub("", name))
    name = re.sub(r"\bang\b[.,]?\s*freq\w*\.?", "Angular frequency", name, flags=re.IGNORECASE)
    return re.sub(r"[\s_]rad_s$", " (rad/s)", name.replace("rad/sec", "rad/s"))


def _blocks(sheet: Sheet) -> Iterator[Sheet]:
    """A sheet parted before each line that names columns, and the lines without results above it."""
    starts = []
    for n, (_, cells) in enumerate(sheet.rows):
        held = {column.quantity for cell in cells if (column := known(cell))}
        if "frequency_Hz" in held and len(held) > 1:
            while n and sum(number(cell) is not None for cell in sheet.rows[n - 1][1]) < _LEAST_NUMBERS:
                n -= 1
            starts.append(n)
    bounds = [0, *starts[1:], len(sheet.rows)]
    for first, last in zip(bounds, bounds[1:], strict=False):
        yield replace(sheet, rows=sheet.rows[first:last])


def _tables(block: Sheet) -> Iterator[Table]:
    """Tests of a block as a table of a mix, each point a specimen of its own, so that none repeats another."""
    for one in rows_of_tests.read([block], {}):
        read = understand(_add_points(attach_units(one.cells)), {"specimen": _POINT})
        if read.form != "moduli":
            raise NotTests(f"{block.path}: no column of the phase; {WANTED}.")
        yield read.table


def _add_points(cells: Cells) -> Cells:
    rows = [(line, [*row, f"line {line}"]) for line, row in cells.rows]
    at = None if cells.at is None else [*cells.at, {}]
    return replace(cells, header=[*cells.header, _POINT], rows=rows, at=at)


def _refusal(said: str, path: str, names: dict[str, str]) -> str:
    """A refusal in the names of the file; options of other commands give way to what a table of a binder needs."""
    said = said.removeprefix(path).removeprefix(": ").replace(f", {_POINT})", ")")
    for ours, theirs in names.items():
        said = said.replace(ours, theirs)
    said = re.sub(r"(?<!\w)E(?=\*|'|_| \()", "G", said)
    if "--" in said or "|" in said.rpartition(";")[2]:
        said = f"{said.rpartition(';')[0]}; {WANTED}."
    return f"{path}{'' if said.startswith(',') else ': '}{said}"
