"""Tables of one quantity each, |E*| and phase, on one sheet or on two: over temperature and frequency, or specimens."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.cells import Block, Cells, Row, Sheet, UnreadNames
from asphalt_nscd.table_import.decimals import match_decimal_mark
from asphalt_nscd.table_import.header_lines import NUMBER, told_above
from asphalt_nscd.table_import.heading import (
    KEYS,
    SPECIMEN,
    TEMPERATURES,
    Heading,
    condition,
    quantity_of,
    read_heading,
)
from asphalt_nscd.table_import.quantities import is_unit, units_in
from asphalt_nscd.table_import.words import ABSENT, COMPUTED_SHEET, OF_SPECIMENS

_ABOVE = 4  # lines above a matrix that say what it is
_ON_AXIS = re.compile(r"([-−+]?\d+(?:[.,]\d+)?)\s*(Hz|(?:[°º]\s*|deg\.?\s*)?[CF])?", re.IGNORECASE)
_NAMES = {"Hz": "f (Hz)", "C": "T (°C)", "F": "T (°F)"}
_CORNER = re.compile(r"\s*(?:\\|\||/(?=\s|[A-Zf]\b)|↓|→)\s*")


class _Value(NamedTuple):
    line: int
    specimen: str
    texts: tuple[str, str]  # of temperature and frequency, as written
    quantity: str
    text: str

    @property
    def key(self) -> tuple[str, float, float]:
        return self.specimen, _number(self.texts[0]), _number(self.texts[1])


class _Axis(NamedTuple):
    """The values of an axis as text, and their name with a unit; empty if nothing tells it."""

    name: str
    texts: list[str]

    def called(self, name: str) -> _Axis:
        return self if self.name else _Axis(name, self.texts)

    def is_cold(self) -> bool:
        """Whether it can be no frequency."""
        return any(text and _number(text) <= 0.0 for text in self.texts)


@dataclass
class _Matrix:
    """The tests of a matrix: `axes` names temperature and frequency, `names` has the headings by quantity.

    `unknown` are texts that stand in place of a heading, `left_out` labels of means and deviations.
    """

    axes: tuple[str, str]
    names: dict[str, str] = field(default_factory=dict)
    unknown: list[str] = field(default_factory=list)
    values: list[_Value] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)


def matches(sheets: Sequence[Sheet]) -> bool:
    """Whether one of the sheets holds a matrix; |E*| may stand on one and the phase on another."""
    return any(_matrices(sheet.rows, sheet.called) for sheet in sheets) or bool(_columns(sheets))


def read(sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Block]:
    """The tests of all matrices in a file, one row for each."""
    path = sheets[0].file
    notes = list(dict.fromkeys(note for sheet in sheets for note in sheet.notes))
    matrices: list[_Matrix] = []
    columns = _columns(sheets)
    for sheet in sheets:
        called = "" if sheet.alone else sheet.called
        own = [*_matrices(sheet.rows, called), *columns.get(sheet.name, [])]
        # A sheet with all quantities of its tests is a specimen's.
        if called and len({value.quantity for one in own for value in one.values}) > 1:
            if COMPUTED_SHEET.match(called):
                notes.append(f"skipped sheet {called}, computed of others")
                continue
            for one in own:
                one.values = [value._replace(specimen=value.specimen or called) for value in one.values]
        matrices += own
    names = _agreed(path, matrices)
    temperature, frequency = matrices[0].axes
    tests: dict[tuple[str, float, float], dict[str, _Value]] = {}
    for value in (value for one in matrices for value in one.values):
        other = tests.setdefault(value.key, {}).setdefault(value.quantity, value)
        if other.text != value.text:
            raise InputError(
                f"{path}, lines {other.line} and {value.line}: {names[value.quantity]} is {other.text} and "
                f"{value.text} at {temperature} {value.texts[0]}, {frequency} {value.texts[1]}; name the specimens "
                "above their matrices, as in `Specimen | A`."
            )
    labels = [SPECIMEN] if any(specimen for specimen, _, _ in tests) else []
    rows = []
    for test in tests.values():
        first = next(iter(test.values()))
        told = [test[name].text if name in test else "" for name in names]
        rows.append((first.line, [first.specimen, *first.texts, *told][1 - len(labels) :]))
    if left_out := dict.fromkeys(repr(label) for one in matrices for label in one.left_out):
        notes.append(f"left out, means and deviations of other columns: {', '.join(left_out)}")
    notes.append(f"matrices of {' and '.join(map(repr, names.values()))} over {temperature} and {frequency}")
    return [Block(Cells(path, [*labels, temperature, frequency, *names.values()], rows, notes))]


def _agreed(path: Path, matrices: list[_Matrix]) -> dict[str, str]:
    """Headings by quantity, which all matrices of a file have in common, as they have their axes."""
    names: dict[str, str] = {}
    for quantity, name in (pair for one in matrices for pair in one.names.items()):
        if names.setdefault(quantity, name) != name:
            raise InputError(
                f"{path}: {names[quantity]!r} and {name!r} stand above two matrices; give all in one unit."
            )
    unknown = [text for one in matrices for text in one.unknown]
    if unknown and not {"E_MPa", "phase_deg"} <= names.keys() and "E1_MPa" not in names:
        raise UnreadNames(f"{path}: {unknown[0]!r} above a matrix is not known; write |E*| or phase for it.")
    if len(axes := {one.axes for one in matrices if one.values}) > 1:
        sides = " and ".join(sorted({name for both in axes for name in both}))
        raise InputError(f"{path}: the matrices have {sides} along their sides; give all in one unit.")
    return names


def _matrices(rows: list[Row], called: str) -> list[_Matrix]:
    """The matrices in the rows of a sheet, below each other or side by side with an empty column between them."""
    whole = [one for one in _below(rows, called) if one.values]
    if whole or not rows:
        return whole
    size = max(len(row) for _, row in rows)
    ends = [n for n in range(size) if not any(row[n : n + 1] != [""] and row[n:] for _, row in rows)]
    parts: list[list[Row]] = [
        [(line, part) for line, row in rows if any(part := row[start + 1 : end])]
        for start, end in zip([-1, *ends], [*ends, size], strict=True)
    ]
    return [one for part in parts if ends for one in _below(part, called) if one.values]


def _below(rows: list[Row], called: str) -> Iterator[_Matrix]:
    """Matrices below each other; `called` is the name of the sheet, which may say quantity and specimen."""
    at, end, specimen = 0, 0, condition(called).get(SPECIMEN, "")
    title = read_heading(called)
    while at < len(rows):
        head = rows[at][1]
        place = _first(head)
        size = _height(rows, at, place)
        if not size:
            at += 1
            continue
        above = [row for _, row in rows[max(end, at - _ABOVE) : at]]
        body = rows[at + 1 : at + 1 + size]
        specimen = told_above(rows[end:at])[0].get(SPECIMEN, specimen)
        axes = _axes(head, [row[place - 1] for _, row in body], above, place)
        named = _quantities(above, head, place) or ({place: title} if title.is_result else {})
        at += 1 + size
        end = at if axes and named else end
        if axes is None:
            continue
        across, down = axes
        turned = quantity_of(across.name) != "frequency_Hz"
        matrix = _Matrix((across.name, down.name) if turned else (down.name, across.name))
        matrix.names = {one.quantity: one.name for one in named.values() if one.quantity}
        matrix.unknown = [one.name for one in named.values() if not one.quantity] or _unknown(above) * (
            not named
        )
        below = [cell for _, row in body for cell in row[place:]]
        for (line, row), deep in zip(body, down.texts, strict=True):
            specimen = row[0] if place > 1 and row[0] else specimen
            heading = Heading("")
            for column, wide in enumerate(across.texts, start=place):
                heading = named.get(column, heading)
                text = row[column] if column < len(row) else ""
                if wide and heading.quantity and text.casefold() not in ABSENT:
                    texts = [
                        match_decimal_mark(one, below) for one in ((wide, deep) if turned else (deep, wide))
                    ]
                    whose = heading.at.get(SPECIMEN, specimen)
                    matrix.values.append(_Value(line, whose, (texts[0], texts[1]), heading.quantity, text))
        yield matrix


def _columns(sheets: Sequence[Sheet]) -> dict[str | None, list[_Matrix]]:
    """By sheet, tables with a column for each specimen, if those of a file give several quantities; else none."""
    held = {sheet.name: list(_specimen_matrices(sheet.rows)) for sheet in sheets}
    several = len({name for own in held.values() for one in own for name in one.names}) > 1
    return held if several else {}


def _specimen_matrices(rows: list[Row]) -> Iterator[_Matrix]:
    """Rows of temperature and frequency below names of specimens, above which the quantity stands with its unit."""
    for at, (_, head) in enumerate(rows):
        quantities = [read_heading(cell).quantity for cell in head]
        if {*quantities} - {""} != {"temperature_C", "frequency_Hz"}:
            continue
        places = [quantities.index(name) for name in ("temperature_C", "frequency_Hz")]
        labels = {n: cell for n, cell in enumerate(head) if cell and n not in places}
        headings = _quantities([row for _, row in rows[max(0, at - 2) : at]], head, min(labels, default=0))
        column = next(iter(headings.values())).column if len(headings) == 1 else None
        measures = {n: cell for n, cell in labels.items() if not OF_SPECIMENS.fullmatch(cell)}
        if (
            column is None
            or column.unit == ""
            or any(units_in(cell) and not is_unit(cell) for cell in measures.values())
        ):
            continue
        others = [cell for n, cell in labels.items() if n not in measures]
        matrix = _Matrix((head[places[0]], head[places[1]]), left_out=others)
        temperature = ""
        for line, row in rows[at + 1 :]:
            texts = [row[n] if n < len(row) else "" for n in (*places, *measures)]
            temperature = texts[0] or temperature
            if not _mostly_numbers(texts) or not NUMBER.fullmatch(texts[1]):
                break
            matrix.names[column.quantity] = next(iter(headings.values())).name
            matrix.values += [
                _Value(line, label, (temperature, texts[1]), column.quantity, text)
                for label, text in zip(measures.values(), texts[2:], strict=True)
                if text.casefold() not in ABSENT
            ]
        yield matrix


def _height(rows: list[Row], at: int, place: int) -> int:
    """How many lines of a matrix stand below line `at`, whose axis begins at `place`; 0 if it is no axis."""
    head = rows[at][1]
    values = [cell for cell in head[place:] if cell]
    # Rows of single tests hold numbers below numbers too; a matrix has an axis above them, in order.
    if place == 0 or not _repeats_one_order(values) or any(_names_each_test(row) for _, row in rows[:at]):
        return 0
    down: list[float] = []
    for _, row in rows[at + 1 :]:
        if any(row[: place - 1]) and not (place == 2 and quantity_of(head[0]) in (SPECIMEN, "replicate")):
            return 0
        body = row[place:]
        if not _mostly_numbers(body) or len(row) > len(head) or not _ON_AXIS.fullmatch(row[place - 1]):
            break
        down.append(_number(row[place - 1]))
    # An axis repeats no value, unless specimens stand in front of it.
    return len(down) if len(down) > 1 and (place == 2 or len(set(down)) == len(down)) else 0


def _mostly_numbers(cells: list[str]) -> bool:
    """Whether cells are results; a word among them is refused as it is read."""
    words = [cell for cell in cells if not NUMBER.fullmatch(cell) and cell.casefold() not in ABSENT]
    return bool(cells) and 2 * len(words) < len(cells)


def _repeats_one_order(values: list[str]) -> bool:
    """Whether values rise or fall, once or again and again: the frequencies of |E*|, then those of the phase."""
    if not all(map(_ON_AXIS.fullmatch, values)):
        return False
    read = [_number(cell) for cell in values]
    size = next((n for n in range(1, len(read)) if read[n] == read[0]), len(read))
    first = read[:size]
    ordered = first in (sorted(set(first)), sorted(set(first), reverse=True))
    return size > 1 and ordered and len(read) % size == 0 and read == first * (len(read) // size)


def _names_each_test(row: list[str]) -> bool:
    """Whether a line names temperature, frequency and a result, as that above rows of single tests does."""
    named = {read_heading(cell).quantity for cell in row}
    return {"temperature_C", "frequency_Hz"} <= named and not named <= {"", SPECIMEN, *KEYS}


def _first(head: list[str]) -> int:
    """Where the values of the axis begin: behind the last text."""
    texts = [n for n, cell in enumerate(head) if cell and not _ON_AXIS.fullmatch(cell)]
    return texts[-1] + 1 if texts else next((n for n, cell in enumerate(head) if cell), 0)


def _number(text: str) -> float:
    """The number of a cell on an axis, which may have its unit behind it."""
    found = _ON_AXIS.fullmatch(text)
    return float((found[1] if found else text).replace(",", ".").replace("−", "-"))


def _unknown(above: list[list[str]]) -> list[str]:
    """The texts above a matrix that stand in place of a quantity, with a unit; the nearest first."""
    return [cell for row in reversed(above) for cell in row if units_in(cell) and not quantity_of(cell)]


def _axes(head: list[str], side: list[str], above: list[list[str]], place: int) -> tuple[_Axis, _Axis] | None:
    """The axis across and the one down; None if not even one is told."""
    across, down = _axis(head[place:]), _axis(side)
    corner = [part for part in _CORNER.split(head[place - 1]) if quantity_of(part) in KEYS]
    over = [cell for row in above for cell in row[1:] if quantity_of(cell) in KEYS]
    first, second, *_ = [*corner, "", ""]
    # A frequency is above zero, whichever name the corner has first.
    temperatures = [quantity_of(name) in TEMPERATURES for name in (first, second)]
    if temperatures == [True, False] and across.is_cold() or temperatures == [False, True] and down.is_cold():
        first, second = (second, first) if second else (first, second)
    across, down = across.called(second or (over[-1] if over else "")), down.called(first)
    # With one axis named the other is known, but not whether a temperature is in degC or degF.
    other = "f (Hz)" if quantity_of(across.name or down.name) in TEMPERATURES else "Temperature"
    if across.name or down.name:
        across, down = across.called(other), down.called(other)
    if {quantity_of(across.name), quantity_of(down.name)} != {"temperature_C", "frequency_Hz"}:
        return None
    return across, down


def _axis(cells: Sequence[str]) -> _Axis:
    """Values of an axis, whose unit may stand behind each."""
    found = [_ON_AXIS.fullmatch(cell) for cell in cells]
    units = {
        match[2].strip("°º ").removeprefix("deg").strip(". ").capitalize()
        for match in found
        if match and match[2]
    }
    texts = [match[1] if match else cell for match, cell in zip(found, cells, strict=True)]
    return _Axis(_NAMES.get(units.pop(), "") if len(units) == 1 else "", texts)


def _quantities(above: list[list[str]], head: list[str], place: int) -> dict[int, Heading]:
    """Headings by the column where their values begin; one for all may stand anywhere above, or in the corner."""
    for row in reversed(above):
        held = {n: one for n, cell in enumerate(row) if (one := read_heading(cell)).is_result}
        # One that is not known ends that in front of it.
        strange = {n: Heading(cell) for n, cell in enumerate(row) if n not in held and _unknown([[cell]])}
        beside = {n: one for n, one in (held | strange).items() if n >= place}
        if held:
            return beside if len(beside) > 1 else {place: next(iter(held.values()))}
    corner = (read_heading(cell) for cell in head[:place])
    return next(({place: one} for one in corner if one.is_result), {})
