"""Summary exports of testing machines (AMPT, UTM): a header block, then frequencies as columns or as rows."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Cells, Row
from asphalt_nscd.table_import.names import celsius, specimen_of
from asphalt_nscd.table_import.quantities import ABSENT, Column, recognise

FAR_FROM_TARGET = 3.0  # K; T 378 lets a test stray by 0.5 K
_HERTZ = re.compile(r"(\d+(?:[.,]\d+)?)\s*(?:Hz)?", re.IGNORECASE)
_IDENTIFICATION = (
    "identification",
    "specimen identification",
    "specimen id",
    "specimen name",
    "specimen",
    "sample id",
)
_TARGET = ("target test temperature", "target temperature", "set temperature", "nominal temperature")
_CONSTANT = ("test temperature", "temperature", "chamber temperature")
_COMMENTS = ("comments", "comment", "remarks")
_DATE = (
    "test date and time",
    "date and time of test",
    "date and time",
    "test date",
    "date of test",
    "date",
    "prüfdatum",
    "date d'essai",
)


@dataclass(frozen=True)
class Block:
    """The tests of one specimen at one temperature, as a table with one row for each test.

    repeated: the operator marked the file or the specimen as a repetition. tested: when, as the header has it.
    """

    cells: Cells
    repeated: bool = False
    tested: str = ""


@dataclass
class _Header:
    """What stands above the results: `label, value` or `label: value`, labels in small letters without units."""

    values: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)

    def take(self, cells: Sequence[str]) -> None:
        label, *rest = [cell for cell in cells if cell] or [""]
        if not rest and ":" in label:
            label, _, value = label.partition(":")
            rest = [value.strip()]
        match = re.fullmatch(r"(.*?)\s*[(\[]([^)\]]*)[)\]]\s*:?", label)
        name = (match[1] if match else label).strip(" :").casefold()
        if not rest or not rest[0]:
            return
        self.values[name] = ", ".join(rest) if name in (*_COMMENTS, *_DATE) else rest[0]
        if match:
            self.units[name] = match[2]

    def first(self, names: Sequence[str]) -> tuple[str, str] | None:
        """Label and value of the first of these labels that the header holds."""
        return next(((name, self.values[name]) for name in names if self.values.get(name)), None)


def blocks(path: Path, rows: list[Row], notes: list[str], called: str) -> list[Block]:
    """The blocks of results in the rows of a file; none if the file is not a machine's export.

    called: name of the file or the sheet, which stands for that of the specimen if the header has none.
    """
    header, found, at = _Header(), [], 0
    while at < len(rows):
        line, cells = rows[at]
        frequencies = _frequencies(cells)
        if frequencies:
            taken = _results(path, rows[at + 1 :], len(frequencies))
            said = list(notes)
            found.append(_as_block(path, header, _turned(path, line, cells, taken, said), said, called))
            at += 1 + len(taken)
        elif _names_columns(cells) and header.first((*_IDENTIFICATION, *_TARGET)):
            table = _listed(path, cells, rows[at + 1 :])
            found.append(_as_block(path, header, table, notes, called))
            at += 1 + len(table.rows)
        else:
            if not _names_columns(cells):
                header.take(cells)
            at += 1
    if not found and header.first(_IDENTIFICATION) and header.first(_TARGET):
        raise InputError(
            f"{path}: a machine export without its line of frequencies; export it anew, or write a line such as "
            "`,25 Hz,10 Hz,1 Hz` above the moduli."
        )
    return found


def _frequencies(cells: list[str]) -> list[str]:
    """Frequencies [Hz] of a line `, 25 Hz, 10 Hz, ...` or `Frequency (Hz), 25, 10, ...`; none if it is another."""
    label, values = cells[0], cells[1:]
    named = _holds(label, "frequency_Hz")
    if (label and not named) or not values or not all(values):
        return []
    numbers = [_HERTZ.fullmatch(value) for value in values]
    if not all(numbers) or not (named or all("hz" in value.casefold() for value in values)):
        return []
    return [match[1] for match in numbers if match]


def _holds(label: str, quantity: str) -> bool:
    column = _recognised(label)
    return column is not None and column.quantity == quantity


def _recognised(label: str) -> Column | None:
    try:
        return recognise(label)
    except (
        InputError
    ):  # of a unit that the quantity does not have: `understand` refuses it with the file's name
        return None


def _names_columns(cells: list[str]) -> bool:
    held = {column.quantity for cell in cells if (column := _recognised(cell))}
    return {"frequency_Hz", "E_MPa"} <= held


def _results(path: Path, rows: list[Row], count: int) -> list[Row]:
    """Lines of results below the frequencies: a label, and as many values as there are frequencies."""
    taken: list[Row] = []
    for line, cells in rows:
        short = len(cells) - 1 < count and len(cells) < 3
        if not cells[0] or short or _frequencies(cells):
            break
        if len(cells) - 1 > count:
            if _recognised(cells[0]) is None:
                break
            raise InputError(
                f"{path}, line {line}: {len(cells) - 1} values below {count} frequencies; if decimals are written "
                "with a comma, separate the columns with semicolons."
            )
        taken.append((line, cells))
    return taken


def _turned(path: Path, line: int, frequencies: list[str], rows: list[Row], notes: list[str]) -> Cells:
    """The results with one line for each frequency, which stands above two columns only if these are equal."""
    header = ["frequency (Hz)", *(cells[0] for _, cells in rows)]
    modulus = next((n for n, cells in rows if _holds(cells[0], "E_MPa")), line)
    turned: dict[float, Row] = {}
    for place, frequency in enumerate(_frequencies(frequencies), start=1):
        values = [cells[place] if place < len(cells) else "" for _, cells in rows]
        hertz = float(frequency.replace(",", "."))
        same = turned.setdefault(hertz, (modulus, [frequency, *values]))
        if same[1][1:] != values:
            raise InputError(
                f"{path}, line {line}: {hertz:g} Hz stands above two columns with different results; remove the column "
                "that does not hold, or correct its frequency. A retest belongs in an export of its own."
            )
        if same[1][0] is not frequency:
            notes.append(f"{hertz:g} Hz stands above two columns with equal results, which count once")
    return Cells(Path(), header, list(turned.values()))


def _listed(path: Path, names: list[str], rows: list[Row]) -> Cells:
    """Results with a line for each frequency, down to the first line with neither frequency nor modulus."""
    wanted = [n for n, name in enumerate(names) if _holds(name, "frequency_Hz") or _holds(name, "E_MPa")]
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


def _as_block(path: Path, header: _Header, results: Cells, notes: list[str], called: str) -> Block:
    """The results with what the header says of all of them: specimen, target temperature, origin."""
    notes = [note for note in notes if not note.startswith("columns separated")]
    columns = [_recognised(name) for name in results.header]
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
    target, temperature_label = _temperature(header, reading)
    known = header.first(_IDENTIFICATION)
    text = known[1] if known else re.sub(r"[_\s-]*Sum(mary)?$", "", called, flags=re.IGNORECASE)
    unit = temperature_label.rstrip(")")[-1:]  # as `_temperature` writes it
    name = specimen_of(text, None if target is None else celsius(target, unit))
    if target is None and reading is None:
        if name.temperature is None:
            raise InputError(
                f"{path}: no temperature; add a line 'Target test temperature (°C)' above the frequencies."
            )
        target, temperature_label = name.temperature, "target temperature (°C)"
        notes.append("temperature taken from the name of the specimen")
    if (
        name.contradicts
        and target
        and unit == "C"
        and not specimen_of(text, celsius(target, "F")).contradicts
    ):
        raise InputError(
            f"{path}: the name {text!r} says {name.temperature} °C and the header {target}, which is the same in "
            "degrees Fahrenheit; write the unit (F) behind the temperature in the header."
        )
    _require_near(path, target, unit, reading, held, rows)
    if name.contradicts:
        notes.append(
            f"the name {text!r} says {name.temperature} °C, the header {target}; the header is taken"
        )
    comments = header.first(_COMMENTS)
    synthetic = comments is not None and comments[1].casefold().startswith("synthetic")
    constants = {"specimen": name.specimen}
    if target is not None:
        constants[temperature_label] = target
    if synthetic:
        constants["origin"] = "synthetic"
    repeated = name.repeated or specimen_of(called, None).repeated
    cells = Cells(
        path,
        [*constants, *results.header],
        [(line, [*constants.values(), *row]) for line, row in rows],
        notes,
    )
    day, time = header.first(_DATE), header.first(("test time", "time"))
    return Block(cells, repeated, " ".join(said[1] for said in (day, time) if said) if day else "")


def _require_near(
    path: Path,
    target: str | None,
    unit: str,
    reading: Column | None,
    held: Mapping[str, int],
    rows: list[Row],
) -> None:
    """Refuse a target that the measured temperatures are far from: the header of another test was left in it."""
    if target is None or reading is None or (reading.unit or "")[-1:] not in ("C", "F", "K"):
        return
    of_reading = str(reading.unit)[-1:]
    texts = [row[held["temperature_C"]] for _, row in rows]
    if not all(re.fullmatch(r"[-−]?\d+(?:[.,]\d+)?", text) for text in texts):
        return  # refused further on
    measured = sorted(celsius(text.replace("−", "-"), of_reading) for text in texts)
    middle = measured[len(measured) // 2]
    if abs(middle - celsius(target, unit)) > FAR_FROM_TARGET:
        raise InputError(
            f"{path}: the target temperature is {target} {unit} and {middle:.3g} C was measured; correct the target "
            "in the header."
        )


def _temperature(header: _Header, reading: Column | None) -> tuple[str | None, str]:
    """Target temperature as the header has it, and the name of a column for it.

    A target without a unit is in that of the measured temperature, or else in degC.
    """
    found = header.first(_TARGET) or header.first(_CONSTANT)
    if found is None:
        return None, ""
    label, value = found
    match = re.fullmatch(r"([-−]?\d+(?:[.,]\d+)?)\s*[°º]?\s*([CFK])?", value)
    if match is None:
        return None, ""
    unit = header.units.get(label) or match[2] or (reading.unit if reading and reading.unit else "C")
    name = f"{label} ({unit})" if label in _TARGET else f"target temperature ({unit})"
    return match[1].replace("−", "-"), name
