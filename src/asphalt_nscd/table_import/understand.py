"""Tests from cells: which column is what and in which unit. What is ambiguous is refused."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.reduction import FORMS, ORIGINS, is_reduced
from asphalt_nscd.table_import.cells import Cells, NotTests
from asphalt_nscd.table_import.columns import Place, chosen_columns, column_cue, name_with_unit, one_of
from asphalt_nscd.table_import.decimals import decimal_mark, normalise_decimal, number
from asphalt_nscd.table_import.header_lines import attach_units
from asphalt_nscd.table_import.heading import known, read_heading
from asphalt_nscd.table_import.melt import melted
from asphalt_nscd.table_import.quantities import ABSENT, QUALITY, Column, derived, recognise
from asphalt_nscd.table_import.rows import CARRIED, tests_in
from asphalt_nscd.table_import.storage_loss import WAYS, fill_whole_modulus

TEXTS = ("specimen", "replicate", "origin")
KEYS = ("temperature_C", "frequency_Hz")
FURTHER = ("nominal_temperature_C", "amplitude_m", "order", "cycles", "time_step_s")  # a diagnosis uses them
_WORDS = {
    "temperature_C": "temperature",
    "frequency_Hz": "frequency",
    "E_MPa": "|E*|",
    "phase_deg": "phase",
    "F0_N": "force",
    "z0_m": "displacement",
    "psi_deg": "phase between force and displacement",
}
MAY_BE_ABSENT = (*QUALITY, "microstrain")
# Form, the angle that it lacks, the other one that stands there, and whose phase is wanted.
_ANGLES = (
    ("moduli", "phase_deg", "psi_deg", "E*"),
    ("peaks", "psi_deg", "phase_deg", "force over displacement"),
)


@dataclass(frozen=True)
class ParsedTable:
    """A table in our columns and units, and how it was read.

    `form` is a key of FORMS. `sources` has, for each of our columns, the user's and the unit it was converted from;
    `modulus_unit` is what |E*| was converted from, empty if it was in MPa.
    """

    table: Table
    form: str
    notes: list[str]
    sources: dict[str, str] = field(default_factory=dict)
    mix: str = ""
    modulus_unit: str = ""


def understand(cells: Cells, chosen: Mapping[str, str] | None = None) -> ParsedTable:
    """Tests of a user's table; `chosen` names columns by what they hold, `{"E_GPa": "Steifigkeit"}`."""
    if not chosen and (ours := _own(cells)):
        return ours
    cells = melted(attach_units(cells))
    columns = _columns(cells, chosen or {})
    form, results = _form(cells, columns)
    places = {name: columns[name][0][0] for name in (*CARRIED, *KEYS, *results) if name in columns}
    cells = tests_in(cells, places, results)
    notes = list(cells.notes)
    kept, copies = {}, set()
    for name, several in columns.items():
        if name in (*TEXTS, "mix", *KEYS, *results):
            kept[name], said, same = one_of(cells, name, several)
            notes += said
            copies |= same
    kept |= _further(columns, form)
    mix = _only_mix(cells, kept)
    values, mark = _values(cells, kept)
    notes += fill_whole_modulus(values)
    notes.append("decimals written with a " + ("comma" if mark == "," else "point"))
    note = _specimens(cells, values)
    sources = {
        name: repr(cells.header[place]) + (f", converted from {column.unit}" if _converts(column) else "")
        for name, (place, column) in kept.items()
    }
    if note:
        notes.append(note)
    read = {place for place, _ in kept.values()} | copies
    if ignored := [name for place, name in enumerate(cells.header) if place not in read]:
        notes.append(f"ignored: {', '.join(map(repr, ignored))}")
    order = [
        "specimen",
        "replicate",
        *KEYS,
        *FORMS["moduli" if form == "modulus" else form],
        "origin",
        *FURTHER,
        *MAY_BE_ABSENT,
    ]
    wanted = [name for name in order if name in values]
    table = Table(cells.path, {name: values[name] for name in wanted}, [line for line, _ in cells.rows])
    modulus = next((kept[name][1] for name in ("E_MPa", "E1_MPa") if name in kept), Column("E_MPa", None))
    return ParsedTable(table, form, notes, sources, mix, (modulus.unit or "") if _converts(modulus) else "")


def _converts(column: Column) -> bool:
    return (column.factor, column.offset) != (1.0, 0.0)


def _own(cells: Cells) -> ParsedTable | None:
    """A table that `reduce` wrote, or one that names records: in our columns already, taken as it is."""
    names = set(cells.header)
    if not is_reduced(names) and not {"record", *KEYS} <= names:
        return None
    columns = {name: [row[place] for _, row in cells.rows] for place, name in enumerate(cells.header)}
    form = "records" if "record" in names else "moduli"
    if "specimen" not in names and "replicate" in names:
        columns["specimen"] = columns.pop("replicate")
    table = Table(cells.path, columns, [line for line, _ in cells.rows])
    table.require(("specimen",))
    return ParsedTable(table, form, [*cells.notes, "columns as `asphalt-nscd reduce` names them"])


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


def _columns(cells: Cells, chosen: Mapping[str, str]) -> dict[str, list[Place]]:
    """Columns by what they hold; several, where names do not tell them apart."""
    found: dict[str, list[Place]] = chosen_columns(cells, chosen)
    settled, taken = set(found), {place for ((place, _),) in found.values()}
    for place, name in enumerate(cells.header):
        try:
            column = recognise(name)
        except InputError as error:
            raise InputError(f"{cells.path}: {error}") from None
        if column is not None and place not in taken and column.quantity not in settled:
            found.setdefault(column.quantity, []).append((place, column))
    for key, nominal in zip(KEYS, ("nominal_temperature_C", "nominal_frequency_Hz"), strict=True):
        if key not in found and nominal in found:
            found[key] = found.pop(nominal)
    return found


def names_force_or_modulus(cell: str) -> bool:
    """Whether a cell names a column of moduli or forces and says the unit, also in a wide table."""
    try:
        column = recognise(read_heading(cell).name)
    except InputError:  # a unit that the quantity does not have
        return True
    return column is not None and column.quantity in ("E_MPa", "F0_N") and column.unit is not None


def _only_mix(cells: Cells, kept: Mapping[str, Place]) -> str:
    """The name of the only mix in the table."""
    if "mix" not in kept:
        return ""
    place, _ = kept["mix"]
    mixes = list(dict.fromkeys(row[place] for _, row in cells.rows))
    if len(mixes) > 1:
        named = ", ".join(mixes[:5]) + (", ..." if len(mixes) > 5 else "")
        raise InputError(
            f"{cells.path}: column {cells.header[place]!r} holds {len(mixes)} mixes ({named}), and a diagnosis is of "
            "one mix: save the rows of each mix as a file of its own and give one of them. If these are specimens of "
            f"one mix, say so {column_cue('specimen', cells.header[place])}."
        )
    return mixes[0]


def _form(cells: Cells, columns: Mapping[str, list[Place]]) -> tuple[str, Sequence[str]]:
    """Moduli where they are complete, in any of WAYS, else peaks; and the columns with the results."""
    ways = [*(("moduli", way) for way in WAYS), ("peaks", FORMS["peaks"])]
    lacking = [(form, way, [name for name in (*KEYS, *way) if name not in columns]) for form, way in ways]
    for form, way, names in lacking:
        if not names:
            return form, way
    missing = {form: next(names for one, _, names in lacking if one == form) for form in ("moduli", "peaks")}
    if missing["moduli"] == ["phase_deg"] and "psi_deg" not in columns and _all_known(cells, columns):
        return "modulus", ("E_MPa",)
    for form, wanted, angle, of in _ANGLES:
        if missing[form] == [wanted] and angle in columns:
            place, column = columns[angle][0]
            raise InputError(
                f"{cells.path}: column {cells.header[place]!r} does not say whose phase it is; if it is that of "
                f"{of}, say so {column_cue(name_with_unit(wanted, column), cells.header[place])}."
            )
    _require_plain(cells, missing["moduli"])
    form = min(missing, key=lambda form: len(missing[form]))  # the nearer one is what was meant
    nothing = {"E_MPa", "F0_N", "z0_m"}.isdisjoint(columns)
    *words, last = (_WORDS[name] for name in missing[form])
    named = ", ".join(name[:60] for name in cells.header)
    wanted = f"columns for {', '.join(words)} and {last}" if words else f"column for {last}"
    raise (NotTests if nothing else InputError)(
        f"{cells.path}: no {wanted} (found: {named}); write names with units, or name a column of "
        f"yours {column_cue(missing[form][0], 'its name')}."
    )


def _require_plain(cells: Cells, missing: Sequence[str]) -> None:
    """Refuse what stands in place of a quantity that is missing, each with its own mend."""
    words = cells.header[0].replace("|", " ").split()  # a name and its unit are two
    if len(cells.header) == 1 and len(words) > 2:
        raise NotTests(
            f"{cells.path}: neither semicolons nor tabs nor commas separate its columns; open it in a spreadsheet, "
            "part the columns there, and save it as CSV or XLSX."
        )
    for kind, name in ((kind, name) for name in cells.header if (kind := derived(name))):
        if kind == "logarithm" and not {"frequency_Hz", "E_MPa"}.isdisjoint(missing):
            raise InputError(
                f"{cells.path}: column {name!r} holds logarithms; give the numbers themselves, =10^x in a spreadsheet."
            )
        if kind == "reduced" and "frequency_Hz" in missing:
            raise NotTests(
                f"{cells.path}: column {name!r} is of a master curve; give temperature and frequency of each test."
            )
    for place, name in enumerate(cells.header):
        held = {
            column.quantity for _, row in cells.rows if (column := known(row[place])) and column.unit != ""
        }
        if len(held) > 1:
            raise InputError(
                f"{cells.path}: column {name!r} says what stands in each line; give |E*| and phase a column each."
            )


def _all_known(cells: Cells, columns: Mapping[str, list[Place]]) -> bool:
    """Whether no column is left that could hold the phase: numbers under a name that is not known."""
    read = {place for places in columns.values() for place, _ in places}
    left = set(range(len(cells.header))) - read
    return not any(re.match(r"[-+]?[.,]?\d", row[place]) for _, row in cells.rows for place in left)


def _values(cells: Cells, columns: dict[str, tuple[int, Column]]) -> tuple[dict[str, list[str]], str]:
    """Columns as text in our units, and the decimal mark of the table."""
    numeric = [place for name, (place, _) in columns.items() if name not in (*TEXTS, "mix")]
    # Over all columns: 1,234 alone can be read in two ways, and another column settles it.
    mark = decimal_mark(
        str(cells.path),
        chain.from_iterable(((line, row[place]) for place in numeric) for line, row in cells.rows),
    )
    values: dict[str, list[str]] = {name: [] for name in columns}
    for line, row in cells.rows:
        for name, (place, column) in columns.items():
            if name in (*TEXTS, "mix"):
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
            in_ours = value * column.factor + column.offset
            if name == "phase_deg" and column.unit == "rad" and 90.0 < abs(in_ours) and abs(value) <= 90.0:
                raise InputError(
                    f"{cells.path}, line {line}: a phase of {row[place]} rad is {in_ours:.0f} deg, more than any "
                    f"material has; if the numbers are degrees, write deg for rad into {cells.header[place]!r}."
                )
            converted = f"{round(in_ours, 2) if column.offset else in_ours:.10g}"  # 0.01 K of degF
            # What needs no conversion keeps the digits that the user wrote.
            values[name].append(converted if _converts(column) else normalise_decimal(row[place], mark))
    return values, mark


def _word(cells: Cells, line: int, name: str, text: str) -> str:
    """Names go into tables that are opened again in spreadsheets, where =, +, - or @ would begin a formula."""
    if name == "origin" and text not in ORIGINS:
        raise InputError(f"{cells.path}, line {line}: origin {text!r} is not one of {', '.join(ORIGINS)}.")
    if not re.fullmatch(r"[^\W_][\w .,:/()+#°&'-]{0,63}", text):
        raise InputError(
            f"{cells.path}, line {line}: {name} {text!r} must begin with a letter or digit and hold at most 64 "
            "letters, digits, spaces and . , : / ( ) + # - _ ° & '; rename it."
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
        # Nothing tells whether it is another specimen or the same again, which scatter differently.
        earlier = first.setdefault(tuple(test), line)
        if earlier != line:
            raise InputError(
                f"{cells.path}, line {line}: repeats the test of line {earlier}, and no column tells specimens "
                f"apart; add a column specimen or replicate, or say which is one, {column_cue('specimen', 'its name')}."
            )
    return "no column of specimens, so all tests are taken as of one specimen"
