"""Tests from cells: which column is what and in which unit. What is ambiguous is refused."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from asphalt_nscd.files.csvinput import Table, Values
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import choice, joined
from asphalt_nscd.measurements.reduction import FORMS, OF_RECORDS, ORIGINS, is_reduced
from asphalt_nscd.table_import.cells import Cells, NotTests, UnreadNames
from asphalt_nscd.table_import.columns import Place, chosen_columns, column_cue, name_with_unit, one_of
from asphalt_nscd.table_import.decimals import decimal_mark, number
from asphalt_nscd.table_import.header_lines import attach_units
from asphalt_nscd.table_import.heading import known, strip_conditions
from asphalt_nscd.table_import.melt import melted
from asphalt_nscd.table_import.quantities import QUALITY, derived, recognise
from asphalt_nscd.table_import.rows import CARRIED, tests_in
from asphalt_nscd.table_import.storage_loss import PARTS, SAID, WAYS, whole_modulus
from asphalt_nscd.table_import.words import ABSENT

TEXTS = ("specimen", "replicate", "origin")
KEYS = ("temperature_C", "frequency_Hz")
FURTHER = ("nominal_temperature_C", "amplitude_m", "order", "cycles", "time_step_s")  # a diagnosis uses them
WORDS_OF = {
    "temperature_C": "temperature",
    "frequency_Hz": "frequency",
    "E_MPa": "|E*|",
    "phase_deg": "phase",
    "F0_N": "force",
    "z0_m": "displacement",
    "psi_deg": "phase between force and displacement",
} | PARTS
MAY_BE_ABSENT = (*QUALITY, "microstrain", "air_voids_percent", "vma_percent", "vfa_percent")
LEAST_PERCENT = {"air_voids_percent": 0.3, "vma_percent": 1.0, "vfa_percent": 1.0}  # of a whole campaign
LARGEST_ANGLE = 360.0  # deg
FEW = 0.125  # share of the tests that may lack a phase: of more the column is not what it seems
# Form, the angle that it lacks, the other one that stands there, and whose phase is wanted.
_ANGLES = (
    ("moduli", "phase_deg", "psi_deg", "E*"),
    ("peaks", "psi_deg", "phase_deg", "force over displacement"),
)


@dataclass(frozen=True)
class Column:
    """A column of a table that was understood: texts, or numbers (n,) in our unit, NaN where a cell is empty.

    `heading` is the user's, and `unit` that which the numbers were converted from, empty if it was ours.
    """

    quantity: str
    unit: str
    values: Values
    heading: str

    @property
    def source(self) -> str:
        """The user's heading, and the unit that was converted."""
        return repr(self.heading) + (f", converted from {self.unit}" if self.unit else "")


@dataclass(frozen=True)
class ParsedTable:
    """A table in our columns and units, how it was read, and the user's columns.

    `form` is a key of FORMS, or "modulus" for |E*| without phases; `without_phase` tells of tests that were left out
    for want of a phase, empty if none was.
    """

    table: Table
    form: str
    notes: list[str]
    read: dict[str, Column] = field(default_factory=dict)
    mix: str = ""
    without_phase: str = ""

    @property
    def modulus_unit(self) -> str:
        """What |E*| was converted from, empty if it was in MPa."""
        return next((self.read[name].unit for name in ("E_MPa", "E1_MPa") if name in self.read), "")


def understand(cells: Cells, chosen: Mapping[str, str] | None = None, mix: str | None = None) -> ParsedTable:
    """Tests of a user's table, of one mix; `chosen` names columns by what they hold, `{"E_GPa": "Steifigkeit"}`."""
    if not chosen and (ours := _own(cells)):
        return ours
    cells = melted(attach_units(cells))
    columns = _columns(cells, chosen or {})
    form, results = _form(cells, columns)
    places = {name: columns[name][0][0] for name in (*CARRIED, *KEYS, *results) if name in columns}
    cells = tests_in(cells, places, results)
    agreed: list[str] = []
    kept, copies = {}, set()
    for name, several in columns.items():
        if name in (*TEXTS, "mix", *KEYS, *results):
            kept[name], told, same = one_of(cells, name, several)
            agreed += told
            copies |= same
    kept |= _further(columns, form)
    cells, of_mix = _choose_mix(cells, kept, mix)
    cells, without_phase = _rows_with_phase(cells, kept)
    notes = [*cells.notes, *agreed]
    # Over all columns: 1,234 alone can be read in two ways, and another column settles it.
    numeric = [place for name, (place, _) in kept.items() if name not in (*TEXTS, "mix")]
    mark = decimal_mark(
        str(cells.path), ((line, row[place]) for line, row in cells.rows for place in numeric)
    )
    read = {name: _column(cells, name, place, mark) for name, place in kept.items()}
    values = {name: column.values for name, column in read.items()}
    if given := [name for name in SAID if name in values and not PARTS.keys().isdisjoint(values)]:
        values["E_MPa"], values["phase_deg"] = whole_modulus(
            {name: np.asarray(values[name]) for name in given}
        )
        notes.append(f"|E*| and phase computed from {' and '.join(SAID[name] for name in given)}")
    _require_order(cells, read)
    _require_percent(cells, read)
    notes.append("decimals written with a " + ("comma" if mark == "," else "point"))
    if note := _specimens(cells, values):
        notes.append(note)
    taken = {place for place, _ in kept.values()} | copies
    if ignored := [name for place, name in enumerate(cells.header) if place not in taken]:
        notes.append(f"ignored: {', '.join(map(repr, ignored))}")
    results = FORMS["moduli" if form == "modulus" else form]
    order = ("specimen", "replicate", *KEYS, *results, "origin", *FURTHER, *MAY_BE_ABSENT)
    wanted = {name: values[name] for name in order if name in values}
    return ParsedTable(
        Table(cells.path, wanted, [line for line, _ in cells.rows]), form, notes, read, of_mix, without_phase
    )


def _require_order(cells: Cells, read: Mapping[str, Column]) -> None:
    """Refuse a modulus and a phase whose names were exchanged: no phase is above 90 deg."""
    if not {"E_MPa", "phase_deg"} <= read.keys():
        return
    modulus, phase = read["E_MPa"], read["phase_deg"]
    if np.nanmedian(np.asarray(phase.values, float)) > 90.0 > np.nanmax(np.asarray(modulus.values, float)):
        raise InputError(
            f"{cells.path}: the numbers below {modulus.heading!r} are as phases, and those below {phase.heading!r} as "
            "moduli; exchange the two names."
        )


def _require_percent(cells: Cells, read: Mapping[str, Column]) -> None:
    """Refuse volumes as shares of one, which a spreadsheet holds in cells that it shows in per cent."""
    for name in LEAST_PERCENT.keys() & read.keys():
        values = np.asarray(read[name].values, float)
        if 0.0 < (largest := np.nanmax(values, initial=0.0)) < LEAST_PERCENT[name]:
            raise InputError(
                f"{cells.path}: {read[name].source}: {largest:g} % at most is less than any mix has; give per cent, "
                "not shares of one."
            )


def _own(cells: Cells) -> ParsedTable | None:
    """A table that `reduce` wrote, or one that names records: in our columns already, taken as it is."""
    names = set(cells.header)
    if not is_reduced(names) and not {"record", *KEYS} <= names:
        return None
    columns: dict[str, Values] = {
        name: [str(row[place]) for _, row in cells.rows] for place, name in enumerate(cells.header)
    }
    form = "records" if "record" in names else "moduli"
    if "specimen" not in names and "replicate" in names:
        columns["specimen"] = columns.pop("replicate")
    table = Table(cells.path, columns, [line for line, _ in cells.rows])
    table.require(("specimen",))
    for name in columns.keys() & {*KEYS, *OF_RECORDS, *FURTHER, *MAY_BE_ABSENT}:
        columns[name] = table.numbers_or_nan(name)
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
        column = recognise(strip_conditions(cell))
    except InputError:  # a unit that the quantity does not have
        return True
    return column is not None and column.quantity in ("E_MPa", "F0_N") and column.unit is not None


def _choose_mix(cells: Cells, kept: Mapping[str, Place], wanted: str | None) -> tuple[Cells, str]:
    """The rows of the mix wanted, or of the only one in the table, and its name."""
    if "mix" not in kept:
        return cells, ""
    place, _ = kept["mix"]
    mixes = list(dict.fromkeys(row[place] for _, row in cells.rows))
    named = ", ".join(mixes[:5]) + ", ..." * (len(mixes) > 5)
    if wanted is not None and wanted not in mixes:
        raise NotTests(
            f"{cells.path}: no mix {wanted!r} in column {cells.header[place]!r}; give one of {named}."
        )
    if wanted is not None and len(mixes) > 1:
        rows = [one for one in cells.rows if one[1][place] == wanted]
        return replace(cells, rows=rows, notes=[*cells.notes, f"mix {wanted} alone, of {named}"]), wanted
    if len(mixes) > 1:
        way = choice(
            f'give one with --only-mix "{mixes[0]}"', "save the rows of each mix as a file of its own"
        )
        raise InputError(
            f"{cells.path}: column {cells.header[place]!r} holds {len(mixes)} mixes ({named}), and a diagnosis is of "
            f"one mix: {way}. If these are specimens of one mix, say so "
            f"{column_cue('specimen', cells.header[place])}."
        )
    return cells, mixes[0]


def _rows_with_phase(cells: Cells, kept: Mapping[str, Place]) -> tuple[Cells, str]:
    """The rows that have a phase, and a sentence on the few that have none; all of them where those are not few."""
    if "phase_deg" not in kept:
        return cells, ""
    place, _ = kept["phase_deg"]
    lines = [line for line, row in cells.rows if row[place].casefold() in ABSENT]
    if not lines or len(lines) > FEW * len(cells.rows):
        return cells, ""
    rows = [one for one in cells.rows if one[0] not in lines]
    told = f"Left out of {cells.path.name}, for its phase is empty: line {', '.join(map(str, lines))}."
    return replace(cells, rows=rows), told


def _form(cells: Cells, columns: Mapping[str, list[Place]]) -> tuple[str, Sequence[str]]:
    """The form: moduli where any of WAYS is complete, else peaks, else |E*| alone; and the columns with the results."""
    ways = [*(("moduli", way) for way in WAYS), ("peaks", FORMS["peaks"])]
    lacking = [(form, way, [name for name in (*KEYS, *way) if name not in columns]) for form, way in ways]
    for form, way, names in lacking:
        if not names:
            return form, way
    missing = {
        form: min((names for one, _, names in lacking if one == form), key=len)
        for form in ("moduli", "peaks")
    }
    # Unless numbers are left under a name that is not known, which could be the phase.
    left = set(range(len(cells.header))) - {place for places in columns.values() for place, _ in places}
    unread = any(re.match(r"[-+]?[.,]?\d", row[place]) for _, row in cells.rows for place in left)
    _require_phases(cells, columns)
    if missing["moduli"] == ["phase_deg"] and "psi_deg" not in columns and not unread:
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
    *words, last = (WORDS_OF[name] for name in missing[form])
    named = ", ".join(name[:60] for name in cells.header)
    wanted = f"columns for {', '.join(words)} and {last}" if words else f"column for {last}"
    raise (NotTests if nothing else UnreadNames)(
        f"{cells.path}: no {wanted} (found: {named}); {_mend(missing[form])}."
    )


def _require_phases(cells: Cells, columns: Mapping[str, list[Place]]) -> None:
    """Refuse a phase that must be a modulus, where none is named."""
    for place, _ in columns.get("phase_deg", []):
        read = [value for _, row in cells.rows if (value := number(row[place])) is not None]
        if "E_MPa" not in columns and np.median(read or [0.0]) > LARGEST_ANGLE:
            raise InputError(
                f"{cells.path}: the numbers below {cells.header[place]!r} are as moduli; write |E*| with its unit for "
                "this name."
            )


def _mend(missing: Sequence[str]) -> str:
    """How to give quantities that no name says."""
    cues = joined([column_cue(name, "NAME") for name in missing])
    way = choice(f"say {cues}, with your own name and unit", "choose in the menus below")
    if len(missing) == 1 and missing[0] in KEYS:
        cell = {"temperature_C": "T = 20 °C", "frequency_Hz": "f = 10 Hz"}[missing[0]]
        return f"add a column, or a line {cell!r} above the names if it is that of all tests, or {way}"
    return f"write |E*|, phase, temperature and frequency with their units as names, or {way}"


def _require_plain(cells: Cells, missing: Sequence[str]) -> None:
    """Refuse a table whose columns are not parted, or hold logarithms, a master curve or several quantities."""
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
        columns = [column for _, row in cells.rows if (column := known(row[place])) and column.unit != ""]
        if len({column.quantity for column in columns}) > 1:
            raise InputError(
                f"{cells.path}: column {name!r} says what stands in each line; give |E*| and phase a column each."
            )


def _column(cells: Cells, name: str, place: Place, mark: str) -> Column:
    """A column of the user in our unit."""
    at, meaning = place
    heading = cells.header[at]
    if name in (*TEXTS, "mix"):
        return Column(name, "", [_word(cells, line, name, row[at]) for line, row in cells.rows], heading)
    values = np.array([_number(cells, name, place, mark, n) for n in range(len(cells.rows))])
    if not meaning.converts:
        return Column(name, "", values, heading)
    ours = values * meaning.factor + meaning.offset
    wide = (np.abs(ours) > 90.0) & (np.abs(values) <= 90.0)
    # A few may be CVs, or are refused where they are used.
    if name == "phase_deg" and meaning.unit == "rad" and wide.mean() > 0.5:
        row = int(np.argmax(wide))
        raise InputError(
            f"{cells.path}, line {cells.rows[row][0]}: a phase of {values[row]:g} rad is {ours[row]:.0f} deg, more "
            f"than any material has; if the numbers are degrees, write deg for rad into {heading!r}."
        )
    return Column(
        name, meaning.unit or "", np.round(ours, 2) if meaning.offset else ours, heading
    )  # 0.01 K of degF


def _number(cells: Cells, name: str, place: Place, mark: str, n: int) -> float:
    """The number in a row of a column, NaN where it may be absent."""
    line, row = cells.rows[n]
    text = row[place[0]]
    value = number(text, mark)
    if value is not None:
        return value
    if name in MAY_BE_ABSENT and text.casefold() in ABSENT:
        return np.nan
    problem = f"{text!r} is not a number" if text else "the cell is empty"
    if not text and cells.path.suffix.startswith((".xls", ".ods")):
        problem += " (a formula not computed?)"
    raise InputError(
        f"{cells.path}, line {line}: {cells.header[place[0]]}: {problem}; write a number or remove the line."
    )


def _word(cells: Cells, line: int, name: str, text: str) -> str:
    """The text of a label; refused if a spreadsheet could take it for a formula, which =, +, - or @ begins."""
    if name == "origin" and text not in ORIGINS:
        raise InputError(f"{cells.path}, line {line}: origin {text!r} is not one of {', '.join(ORIGINS)}.")
    if not re.fullmatch(r"[^\W_][\w .,:/()+#°&%'-]{0,63}", text):
        raise InputError(
            f"{cells.path}, line {line}: {name} {text!r} must begin with a letter or digit and hold at most 64 "
            "letters, digits, spaces and . , : / ( ) + # - _ ° & % '; rename it."
        )
    return text


def _telling(cells: Cells, tests: list[tuple[object, ...]]) -> str:
    """How a user says which column tells equal tests apart, or which two, mix and specimen; empty for none."""
    labels: dict[str, list[str]] = {}
    for place, name in enumerate(cells.header):
        texts: list[str] = []
        for _, row in cells.rows:  # one that stands in the first row of several alone is of all
            texts.append(row[place] or (texts[-1] if texts else ""))
        if known(name) is None and 1 < len(set(texts)) < len(texts) / 2:
            labels[name] = texts
    for name, texts in labels.items():
        if len(set(zip(tests, texts, strict=True))) == len(texts):
            return column_cue("specimen", name)
    for two in combinations(sorted(labels, key=lambda name: len(set(labels[name]))), 2):
        if len(set(zip(tests, *map(labels.get, two), strict=True))) == len(tests):
            return " and ".join(map(column_cue, ("mix", "specimen"), two))
    return ""


def _specimens(cells: Cells, values: dict[str, Values]) -> str:
    """Put the specimen of each test into `values`; a note on how it was told. Refuses tests that nothing parts."""
    note = ""
    if "specimen" not in values and "replicate" in values:
        values["specimen"] = values.pop("replicate")
        note = f"{len(set(values['specimen']))} replicates, taken as specimens"
    named = "specimen" in values
    if not named:
        values["specimen"] = ["1"] * len(cells.rows)
        note = "no column of specimens, so all tests are taken as of one specimen"
    wanted = ("specimen", "replicate", *KEYS, "amplitude_m", "order", "cycles")
    tests = list(zip(*(values[name] for name in wanted if name in values), strict=True))
    first: dict[tuple[object, ...], int] = {}
    for (line, _), test in zip(cells.rows, tests, strict=True):
        # Nothing tells whether it is another specimen or the same again, which scatter differently.
        earlier = first.setdefault(test, line)
        if earlier == line:
            continue
        cue = _telling(cells, tests)
        if named and not cue:
            break  # a test that is repeated is refused where all parts are known
        way = f", or say that one is, {cue}" if cue else ""
        raise InputError(
            f"{cells.path}, line {line}: repeats the test of line {earlier}, and no column tells specimens apart; add "
            f"a column specimen{way}."
        )
    return note
