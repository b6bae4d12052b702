"""Tests from cells: which column is what and in which unit. What is ambiguous is refused."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.reduction import FORMS, ORIGINS, REDUCED_COLUMNS
from asphalt_nscd.table_import.cells import Cells, NotTests
from asphalt_nscd.table_import.decimals import decimal_mark, number
from asphalt_nscd.table_import.quantities import ABSENT, MEASURED, QUALITY, Column, is_unit, recognise
from asphalt_nscd.table_import.wide import melted, without_condition

TEXTS = ("specimen", "replicate", "origin")
KEYS = ("temperature_C", "frequency_Hz")
FURTHER = ("nominal_temperature_C", "amplitude_m", "order", "cycles", "time_step_s")  # a diagnosis uses them
MAY_BE_ABSENT = (*QUALITY, "microstrain")
# Form, the angle that it lacks, the other one that stands there, and whose phase is wanted.
_ANGLES = (
    ("moduli", "phase_deg", "psi_deg", "E*"),
    ("peaks", "psi_deg", "phase_deg", "force over displacement"),
)
Place = tuple[int, Column]  # of a column, and what it holds


@dataclass(frozen=True)
class Understood:
    """A table in our columns and units, its form (a key of FORMS), and sentences on how it was read.

    sources: for each of our columns the user's, and the unit it was converted from.
    """

    table: Table
    form: str
    notes: list[str]
    sources: dict[str, str] = field(default_factory=dict)


def understand(cells: Cells, chosen: Mapping[str, str] | None = None) -> Understood:
    """Tests of a user's table.

    chosen: names of columns by what they hold, `{"E_GPa": "Steifigkeit"}`, where a name does not tell.
    """
    if not chosen and (ours := _own(cells)):
        return ours
    cells, notes = melted(_with_units(cells))
    notes = [*cells.notes, *notes]
    columns = _columns(cells, chosen or {})
    form = _form(cells, columns)
    kept = {
        name: _single(cells, name, places)
        for name, places in columns.items()
        if name in (*TEXTS, *KEYS, *FORMS[form])
    } | _further(columns, form)
    values, mark = _values(cells, kept)
    notes.append("decimals written with a " + ("comma" if mark == "," else "point"))
    note = _specimens(cells, values)
    sources = {
        name: repr(cells.header[place]) + (f", converted from {column.unit}" if _converts(column) else "")
        for name, (place, column) in kept.items()
    }
    if note:
        notes.append(note)
    read = {place for place, _ in kept.values()}
    if ignored := [name for place, name in enumerate(cells.header) if place not in read]:
        notes.append(f"ignored: {', '.join(map(repr, ignored))}")
    order = ["specimen", "replicate", *KEYS, *FORMS[form], "origin", *FURTHER, *MAY_BE_ABSENT]
    wanted = [name for name in order if name in values]
    table = Table(cells.path, {name: values[name] for name in wanted}, [line for line, _ in cells.rows])
    return Understood(table, form, notes, sources)


def _converts(column: Column) -> bool:
    return (column.factor, column.offset) != (1.0, 0.0)


def _own(cells: Cells) -> Understood | None:
    """A table that `reduce` wrote, or one that names records: in our columns already, taken as it is."""
    names = set(cells.header)
    if not set(REDUCED_COLUMNS) <= names and not {"record", *KEYS} <= names:
        return None
    columns = {name: [row[place] for _, row in cells.rows] for place, name in enumerate(cells.header)}
    form = "records" if "record" in names else "moduli"
    table = Table(cells.path, columns, [line for line, _ in cells.rows])
    return Understood(table, form, [*cells.notes, "columns as `asphalt-nscd reduce` names them"])


def _further(columns: dict[str, list[Place]], form: str) -> dict[str, Place]:
    """Columns beside the tests themselves, where exactly one column gives each, with its unit."""
    found = {
        name: columns[name][0]
        for name in (*FURTHER, *MAY_BE_ABSENT)
        if len(columns.get(name, [])) == 1 and columns[name][0][1].unit is not None
    }
    amplitude = columns.get("z0_m", [])
    # Beside moduli a displacement is no peak to reduce.
    if form == "moduli" and "amplitude_m" not in found and len(amplitude) == 1 and amplitude[0][1].unit:
        found["amplitude_m"] = amplitude[0]
    return found


def _with_units(cells: Cells) -> Cells:
    """Units in a line of their own below the names are put behind these."""
    line, units = cells.rows[0]
    if not all(is_unit(unit) for unit in units if unit) or not any(units):
        return cells
    header = [
        f"{name} ({unit.strip('()[]')})" if unit else name
        for name, unit in zip(cells.header, units, strict=True)
    ]
    if len(cells.rows) == 1:
        raise InputError(f"{cells.path}: no line with numbers; add a line for each test.")
    return Cells(cells.path, header, cells.rows[1:], [*cells.notes, f"units from line {line}"])


def _columns(cells: Cells, chosen: Mapping[str, str]) -> dict[str, list[Place]]:
    """Columns by what they hold; several, where names do not tell them apart."""
    found: dict[str, list[Place]] = {}
    for wanted, name in chosen.items():
        column = recognise(wanted)
        if column is None or column.unit is None:
            names = ", ".join(MEASURED)
            raise InputError(
                f"--column {wanted}: not known; give one of {names}, with the unit of your column."
            )
        if cells.header.count(name) != 1:
            raise InputError(f"{cells.path}: no column {name!r}; its columns are {', '.join(cells.header)}.")
        found[column.quantity] = [(cells.header.index(name), column)]
    settled, taken = set(found), {place for ((place, _),) in found.values()}
    for place, name in enumerate(cells.header):
        try:
            column = recognise(name)
        except InputError as error:
            raise InputError(f"{cells.path}: {error}") from None
        if column is not None and place not in taken and column.quantity not in settled:
            found.setdefault(column.quantity, []).append((place, column))
    if "temperature_C" not in found and "nominal_temperature_C" in found:
        found["temperature_C"] = found.pop("nominal_temperature_C")
    return found


def names_force_or_modulus(cell: str) -> bool:
    """Whether a cell is the name of a column with moduli or forces and says their unit, also of a wide table."""
    try:
        column = recognise(without_condition(cell))
    except InputError:  # a unit that the quantity does not have
        return True
    return column is not None and column.quantity in ("E_MPa", "F0_N") and column.unit is not None


def _single(cells: Cells, name: str, places: list[Place]) -> Place:
    """The one column of a quantity, with its unit."""
    (place, column), *others = places
    if others:
        names = [cells.header[place] for place, _ in places]
        if len(set(names)) < len(names):
            raise InputError(f"{cells.path}: column {names[0]!r} appears twice; remove one or rename it.")
        both = " and ".join(map(repr, names))
        raise InputError(
            f"{cells.path}: columns {both} may each be {name}; say which with "
            f'--column {_as_written(name, column)}="{cells.header[place]}", or remove the others.'
        )
    if column.unit is None:
        stem, _, unit = name.rpartition("_")
        raise InputError(
            f"{cells.path}: column {cells.header[place]!r} does not say its unit; write it after the name, "
            f"as in {stem} ({unit})."
        )
    return place, column


def _as_written(name: str, column: Column) -> str:
    """Our name of a quantity with the unit that a column has: E_GPa."""
    return f"{name.rpartition('_')[0]}_{column.unit}" if column.unit else name


def _form(cells: Cells, columns: Mapping[str, list[Place]]) -> str:
    """Moduli where they are complete, else peaks."""
    missing = {
        form: [name for name in (*KEYS, *FORMS[form]) if name not in columns] for form in ("moduli", "peaks")
    }
    for form, names in missing.items():
        if not names:
            return form
    for form, wanted, angle, of in _ANGLES:
        if missing[form] == [wanted] and angle in columns:
            place, column = columns[angle][0]
            raise InputError(
                f"{cells.path}: column {cells.header[place]!r} does not say whose phase it is; if it is that of "
                f'{of}, say so with --column {_as_written(wanted, column)}="{cells.header[place]}".'
            )
    form = min(missing, key=lambda form: len(missing[form]))  # the nearer one is what was meant
    nothing = {"E_MPa", "F0_N", "z0_m"}.isdisjoint(columns)
    raise (NotTests if nothing else InputError)(
        f"{cells.path}: no column for {' and '.join(missing[form])} (found: {', '.join(cells.header)}); write names "
        f'with units, or name a column of yours with --column {missing[form][0]}="its name".'
    )


def _values(cells: Cells, columns: dict[str, tuple[int, Column]]) -> tuple[dict[str, list[str]], str]:
    """Columns as text in our units, and the decimal mark of the table."""
    numeric = [place for name, (place, _) in columns.items() if name not in TEXTS]
    mark = decimal_mark(
        str(cells.path),
        chain.from_iterable(((line, row[place]) for place in numeric) for line, row in cells.rows),
    )
    values: dict[str, list[str]] = {name: [] for name in columns}
    for line, row in cells.rows:
        for name, (place, column) in columns.items():
            if name in TEXTS:
                values[name].append(_word(cells, line, name, row[place]))
                continue
            value = number(row[place], mark)
            if value is None and name in MAY_BE_ABSENT and row[place].casefold() in ABSENT:
                values[name].append("")
                continue
            if value is None:
                problem = (
                    f"{row[place]!r} is not a number"
                    if row[place]
                    else "the cell is empty (a formula not computed?)"
                )
                raise InputError(
                    f"{cells.path}, line {line}: {cells.header[place]}: {problem}; write a number or remove the line."
                )
            converted = f"{value * column.factor + column.offset:.10g}"
            values[name].append(converted if _converts(column) else row[place].replace(",", "."))
    return values, mark


def _word(cells: Cells, line: int, name: str, text: str) -> str:
    """Names go into tables that are opened again in spreadsheets, where =, +, - or @ would begin a formula."""
    if name == "origin" and text not in ORIGINS:
        raise InputError(f"{cells.path}, line {line}: origin {text!r} is not one of {', '.join(ORIGINS)}.")
    if not re.fullmatch(r"[^\W_][\w .,:/()+#-]{0,63}", text):
        raise InputError(
            f"{cells.path}, line {line}: {name} {text!r} must begin with a letter or digit and hold at most 64 "
            "letters, digits and . , : / ( ) + # -; rename it."
        )
    return text


def _specimens(cells: Cells, values: dict[str, list[str]]) -> str:
    """Put a specimen to each test, and say how it was told."""
    if "specimen" in values:
        return ""
    if "replicate" in values:
        values["specimen"] = values.pop("replicate")
        return f"{len(set(values['specimen']))} replicates, taken as specimens"
    values["specimen"] = ["1"] * len(cells.rows)
    distinguishing = [values[name] for name in (*KEYS, "amplitude_m", "order", "cycles") if name in values]
    first: dict[tuple[str, ...], int] = {}
    for (line, _), *test in zip(cells.rows, *distinguishing, strict=True):
        earlier = first.setdefault(tuple(test), line)
        if earlier != line:
            raise InputError(
                f"{cells.path}, line {line}: repeats the test of line {earlier}, and no column tells specimens "
                "apart; add a column specimen or replicate."
            )
    return "no column of specimens, so all tests are taken as of one specimen"
