"""Summary exports of testing machines (AMPT, UTM): a header block, then frequencies as columns or as rows."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Block, Cells, Row, Sheet
from asphalt_nscd.table_import.decimals import decimal_mark, match_decimal_mark
from asphalt_nscd.table_import.header_lines import require_rows
from asphalt_nscd.table_import.heading import known, quantity_of
from asphalt_nscd.table_import.names import celsius, file_label, specimen_of
from asphalt_nscd.table_import.quantities import Meaning, unit_in
from asphalt_nscd.table_import.targets import FAR, Header, decided, median_reading
from asphalt_nscd.table_import.words import ABSENT, WORDS

# A bare number is a frequency only where the label in front says so: `Frequency (Hz), 25, 10`.
_HERTZ = re.compile(r"(\d+(?:[.,]\d+)?)\s*(Hz|rad/s)?", re.IGNORECASE)
_IDENTIFICATION, _TARGET, _CONSTANT, _COMMENTS, _DATE = WORDS["export"].values()
_NEEDED = {"E_MPa": "moduli", "phase_deg": "phases"}


@dataclass
class _Header:
    """What stands above the results: `label, value` or `label: value`, labels in small letters without units."""

    values: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)

    def take(self, cells: Sequence[str]) -> None:
        """Enter label and value of a line, if it has both and does not name columns."""
        label, *rest = [cell for cell in cells if cell] or [""]
        if _names_columns(cells):
            return
        if not rest and ":" in label:
            label, _, value = label.partition(":")
            rest = [value.strip()]
        match = re.fullmatch(r"(.*?)\s*[(\[]([^)\]]*)[)\]]\s*:?", label)
        name = (match[1] if match else label).strip(" :").casefold()
        # `Specimen, Temperature (°C), 4, 20` names columns, and no specimen.
        if not rest or not rest[0] or quantity_of(rest[0]) == "temperature_C":
            return
        # `Sat, Dec 7, 2019, 10:25 AM` is three cells where commas part the columns.
        self.values[name] = ", ".join(rest) if name in (*_COMMENTS, *_DATE) else rest[0]
        if match:
            self.units[name] = match[2]

    def first(self, names: Sequence[str]) -> tuple[str, str] | None:
        """Label and value of the first of these labels that the header holds."""
        return next(((name, self.values[name]) for name in names if self.values.get(name)), None)


def matches(sheets: Sequence[Sheet]) -> bool:
    """Whether a sheet is an export: a line of frequencies, results below a header, or a header alone."""
    if len(sheets) > 1:
        return False
    header, rows = _Header(), sheets[0].rows
    for at, (_, cells) in enumerate(rows):
        if _frequencies(cells) or _lists(header, cells, rows[at:]):
            return True
        header.take(cells)
    return bool(header.first(_IDENTIFICATION) and header.first(_TARGET))


def read(sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Block]:
    """Blocks of results in a machine's export; the file is the specimen if no header names it."""
    sheet = sheets[0]
    path, rows, notes, called = sheet.path, sheet.rows, sheet.notes, sheet.called
    require_rows(path, rows)
    header, found, at = _Header(), [], 0
    several = sum(bool(_frequencies(cells)) or _names_columns(cells) for _, cells in rows) > 1
    while at < len(rows):
        line, cells = rows[at]
        if frequencies := _frequencies(cells):
            taken = _results(path, rows[at + 1 :], len(frequencies))
            _require_whole(path, frequencies, taken, rows[at + 1 + len(taken) :])
            said = list(notes)
            table = _turned(path, line, cells, taken, said)
            found.append(_result_block(path, header, table, said, called, several))
            at += 1 + len(taken)
        elif _lists(header, cells, rows[at:]):
            table = _listed(path, cells, rows[at + 1 :])
            found.append(_result_block(path, header, table, notes, called, several))
            at += 1 + len(table.rows)
        else:
            header.take(cells)
            at += 1
    if not found:
        for line, cells in rows:
            # `0,1 Hz` between commas has become two cells, one of which is no frequency.
            if sum("hz" in cell.casefold() for cell in cells) > 1:
                wrong = next((cell for cell in cells[1:] if not _frequencies(["", cell])), "")
                raise InputError(
                    f"{path}, line {line}: {wrong!r} stands among the frequencies and is none; if decimals are "
                    "written with a comma, separate the columns with semicolons."
                )
        raise InputError(
            f"{path}: a machine export without its line of frequencies; if the file ends early, export it anew, else "
            "write a line such as `,25 Hz,10 Hz,1 Hz` above the moduli."
        )
    return found


def _lists(header: _Header, cells: list[str], rows: list[Row]) -> bool:
    """Whether a line names the columns of an export's results, of one specimen at one temperature."""
    return (
        _names_columns(cells)
        and bool(header.first((*_IDENTIFICATION, *_TARGET)))
        and _one_target(cells, rows)
    )


def _frequencies(cells: list[str]) -> list[str]:
    """Frequencies of a line `, 25 Hz, 10 Hz, ...` or `Frequency (Hz), 25, 10, ...`, in Hz or rad/s; else none."""
    label, values = cells[0], cells[1:]
    named = quantity_of(label) == "frequency_Hz"
    if (label and not named) or not values or not all(values):
        return []
    numbers = [_HERTZ.fullmatch(value) for value in values]
    if not all(numbers) or not (named or all(match[2] for match in numbers if match)):
        return []
    return [match[1] for match in numbers if match]


def _frequency_name(path: Path, line: int, cells: list[str]) -> str:
    """The name of a column for the frequencies of a line, with their unit."""
    units = {match[2].casefold() for cell in cells[1:] if (match := _HERTZ.fullmatch(cell)) and match[2]}
    named = known(cells[0])
    if named is not None and named.unit:
        units.add(named.unit.casefold())
    if len(units) > 1:
        raise InputError(f"{path}, line {line}: frequencies in both Hz and rad/s; give all in Hz.")
    return "omega (rad/s)" if units == {"rad/s"} else "frequency (Hz)"


def _names_columns(cells: Sequence[str]) -> bool:
    return {"frequency_Hz", "E_MPa"} <= set(map(quantity_of, cells))


def _one_target(names: list[str], rows: list[Row]) -> bool:
    """Whether the rows below names of columns are at one temperature, as in an export; a table has several."""
    places = [n for n, name in enumerate(names) if quantity_of(name) == "temperature_C"][:1]
    texts = [row[n] for _, row in rows[1:] for n in places if n < len(row)]
    read = [float(text.replace(",", ".")) for text in texts if re.fullmatch(r"-?\d+(?:[.,]\d+)?", text)]
    return not read or max(read) - min(read) <= FAR


def _results(path: Path, rows: list[Row], count: int) -> list[Row]:
    """Lines of results below the frequencies: a label, and as many values as there are frequencies."""
    taken: list[Row] = []
    for line, cells in rows:
        # A label and two values are a row, if need be one cut off; `label, value` is a line of the next header.
        short = len(cells) - 1 < count and len(cells) < 3
        if not cells[0] or short or _frequencies(cells):
            break
        if len(cells) - 1 > count:
            if known(cells[0]) is None:
                break
            raise InputError(
                f"{path}, line {line}: {len(cells) - 1} values below {count} frequencies; if decimals are written "
                "with a comma, separate the columns with semicolons."
            )
        taken.append((line, cells))
    return taken


def _require_whole(path: Path, frequencies: list[str], taken: list[Row], rest: list[Row]) -> None:
    """Refuse the results with which a file ends if they lack a row, or a part of the last one: it was cut off."""
    # Something follows the results, so the file does not end within them.
    if len(rest) > 1 or (rest and len(rest[0][1]) > len(frequencies)):
        return
    named = {quantity_of(cells[0]) for _, cells in taken}
    line, last = (taken + rest)[-1] if taken or rest else (0, [""])
    missing = frequencies[len(last) - 1 :]
    longer = any(len(cells) > len(last) for _, cells in taken)
    if quantity_of(last[0]) in (*_NEEDED, "temperature_C") and missing and longer:
        raise InputError(
            f"{path}, line {line}: the file ends early: {last[0]} has no value for the frequencies "
            f"{', '.join(missing)}; export it anew."
        )
    lacking = [word for name, word in _NEEDED.items() if name not in named]
    # A row that is not known may stand for it.
    if lacking and named.isdisjoint(("", "F0_N")):
        raise InputError(
            f"{path}: the file ends early, without a row of {' and of '.join(lacking)}; export it anew."
        )


def _turned(path: Path, line: int, frequencies: list[str], rows: list[Row], notes: list[str]) -> Cells:
    """The results with one line for each frequency, which stands above two columns only if these are equal."""
    header = [_frequency_name(path, line, frequencies), *(cells[0] for _, cells in rows)]
    unit = "rad/s" if "rad/s" in header[0] else "Hz"
    # A turned row has no line of its own in the file: messages name that of the modulus.
    modulus = next((n for n, cells in rows if quantity_of(cells[0]) == "E_MPa"), line)
    turned: dict[float, Row] = {}
    below = [(n, cell) for n, cells in rows if known(cells[0]) for cell in cells[1:]]
    headings = [match_decimal_mark(text, [cell for _, cell in below]) for text in _frequencies(frequencies)]
    decimal_mark(
        str(path), [*((line, text) for text in headings), *below]
    )  # the lines of both are known here
    for place, frequency in enumerate(headings, start=1):
        values = [cells[place] if place < len(cells) else "" for _, cells in rows]
        value = float(frequency.replace(",", "."))
        twice = value in turned
        same = turned.setdefault(value, (modulus, [frequency, *values]))
        if same[1][1:] != values:
            raise InputError(
                f"{path}, line {line}: {value:g} {unit} stands above two columns with different results; remove the "
                "column that does not hold, or correct its frequency. A retest belongs in an export of its own."
            )
        if twice:
            notes.append(f"{value:g} {unit} stands above two columns with equal results, which count once")
    return Cells(Path(), header, list(turned.values()))


def _listed(path: Path, names: list[str], rows: list[Row]) -> Cells:
    """Results with a line for each frequency, down to the first line with neither frequency nor modulus."""
    wanted = [n for n, name in enumerate(names) if quantity_of(name) in ("frequency_Hz", "E_MPa")]
    taken: list[Row] = []
    for line, cells in rows:
        filled = [*cells, *[""] * (len(names) - len(cells))]
        if not any(_HERTZ.fullmatch(filled[place]) for place in wanted):
            break
        if len(filled) > len(names):
            raise InputError(
                f"{path}, line {line}: {len(cells)} fields under {len(names)} column names; if decimals are written "
                "with a comma, separate the columns with semicolons."
            )
        taken.append((line, filled))
    return Cells(path, names, taken)


def _result_block(
    path: Path, header: _Header, results: Cells, notes: list[str], called: str, several: bool
) -> Block:
    """The results with what the header says of all of them: specimen, target temperature, origin."""
    notes = [note for note in notes if not note.startswith("columns separated")]
    columns = [known(name) for name in results.header]
    held = {column.quantity: place for place, column in enumerate(columns) if column}
    measured = [place for name in ("E_MPa", "phase_deg") if (place := held.get(name)) is not None]
    rows = [
        (line, row)
        for line, row in results.rows
        if not measured or any(row[place].casefold() not in ABSENT for place in measured)
    ]
    if not rows:
        raise InputError(f"{path}: no frequency has a modulus; remove the file or repeat its tests.")
    if len(rows) < len(results.rows):
        notes.append(f"frequencies without a modulus left out: {len(results.rows) - len(rows)}")
    reading = columns[held["temperature_C"]] if "temperature_C" in held else None
    identified = header.first(_IDENTIFICATION)
    stem = file_label(called)
    text = identified[1] if identified else stem
    reached = median_reading(rows, held.get("temperature_C"), reading.unit if reading else None)
    # The name of a file with several blocks says no more than where it begins.
    names = [text] if several else list(dict.fromkeys([text, stem]))
    target = decided(path, _target(path, header, reading), names, reached, notes)
    unit = "" if target is None else target.column.rstrip(")")[-1:]
    name = specimen_of(text, None if target is None else celsius(target.text, unit))
    comments = header.first(_COMMENTS)
    # The tutorial's exports are invented and say so here; without it they would be reported as measured.
    synthetic = comments is not None and comments[1].casefold().startswith("synthetic")
    constants = {"specimen": name.specimen}
    if target is not None:
        constants[target.column] = target.text
    if synthetic:
        constants["origin"] = "synthetic"
    repeated = name.repeated or specimen_of(called, None).repeated
    cells = Cells(
        path,
        [*constants, *results.header],
        [(line, [*constants.values(), *row]) for line, row in rows],
        notes,
    )
    # A time of day without its date puts no two tests in order.
    day, time = header.first(_DATE), header.first(("test time", "time"))
    when = " ".join(said[1] for said in (day, time) if said) if day else ""
    unnamed = identified is None and name.temperature is None
    return Block(cells, True, repeated, when, "" if target is None else target.contested, unnamed)


def _target(path: Path, header: _Header, reading: Meaning | None) -> Header | None:
    """Target temperature as the header has it; without a unit it is in that of the measured one, or else in degC."""
    # The set value before a reading: an isotherm has one set value, and readings wander about it.
    label, value = header.first(_TARGET) or header.first(_CONSTANT) or ("", "")
    match = re.fullmatch(r"([-−]?\d+(?:[.,]\d+)?)\s*[°º]?\s*([CFK])?", value)
    if match is None:
        return None
    said = header.units.get(label) or match[2] or (reading.unit if reading and reading.unit else "C")
    unit = unit_in(f"x ({said})")
    if unit not in ("C", "F", "K"):
        raise InputError(f"{path}: {said!r} is no unit of the {label}; give one of C, K, F in the header.")
    name = label if label in _TARGET else "target temperature"
    return Header(match[1].replace("−", "-"), unit, f"{name} ({unit})")
