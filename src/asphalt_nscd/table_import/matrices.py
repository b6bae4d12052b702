"""Matrices of temperature by frequency, one for |E*| and one for the phase, on one sheet or on two."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.blocks import Block
from asphalt_nscd.table_import.cells import Cells, Row, Sheet
from asphalt_nscd.table_import.decimals import match_decimal_mark
from asphalt_nscd.table_import.header_lines import NUMBER, told_above
from asphalt_nscd.table_import.heading import KEYS, SPECIMEN, Heading, condition, known, read_heading
from asphalt_nscd.table_import.quantities import units_in
from asphalt_nscd.table_import.words import ABSENT, COMPUTED_SHEET

_ABOVE = 4  # lines above a matrix that say what it is
_AXIS_UNIT = re.compile(r"([-−+]?\d+(?:[.,]\d+)?)\s*(Hz|(?:[°º]\s*|deg\.?\s*)?[CF])", re.IGNORECASE)
_NAMES = {"Hz": "f (Hz)", "C": "T (°C)", "F": "T (°F)"}


@dataclass(frozen=True)
class _Value:
    line: int
    key: tuple[str, float, float]  # specimen, temperature, frequency
    texts: tuple[str, str]  # of temperature and frequency, as written
    quantity: str
    text: str


@dataclass(frozen=True)
class _Axis:
    """Where the values of an axis stand in words: their name with a unit, and these as text."""

    name: str
    texts: list[str]

    @property
    def quantity(self) -> str:
        column = known(self.name)
        return "" if column is None else column.quantity


def matches(sheets: Sequence[Sheet]) -> bool:
    """Whether one of the sheets holds a matrix; |E*| may stand on one and the phase on another."""
    return any(found for sheet in sheets for found, _, _ in _matrices(sheet.rows, sheet.called))


def read(sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Block]:
    """The tests of all matrices in a file, one row for each."""
    path = sheets[0].file
    notes = list(dict.fromkeys(note for sheet in sheets for note in sheet.notes))
    values: list[_Value] = []
    headings: dict[str, str] = {}
    axes: set[tuple[str, str]] = set()
    unnamed: list[str] = []
    for sheet in sheets:
        called = "" if sheet.alone else sheet.called
        matrices = list(_matrices(sheet.rows, called))
        # A sheet with all quantities of its tests is a specimen's.
        whole = len({value.quantity for found, _, _ in matrices for value in found}) > 1
        if whole and called and COMPUTED_SHEET.match(called):
            notes.append(f"skipped sheet {called}, computed of others")
            continue
        for found, axis, named in matrices:
            if not found:
                unnamed += named.values()
                continue
            values += (
                [replace(one, key=(one.key[0] or called, *one.key[1:])) for one in found] if whole else found
            )
            axes.add(axis)
            for quantity, name in named.items():
                if headings.setdefault(quantity, name) != name:
                    raise InputError(
                        f"{path}: {headings[quantity]!r} and {name!r} stand above two matrices; give all in one unit."
                    )
    if unnamed and not {"E_MPa", "phase_deg"} <= headings.keys() and "E1_MPa" not in headings:
        raise InputError(
            f"{path}: {unnamed[0]!r} above a matrix is no quantity that is known; write |E*| or phase for it, with "
            "its unit."
        )
    if len(axes) > 1:
        raise InputError(
            f"{path}: the matrices have {_listed(axes)} along their sides; give all in one unit."
        )
    ((temperature, frequency),) = axes
    tests: dict[tuple[str, float, float], dict[str, _Value]] = {}
    for value in values:
        other = tests.setdefault(value.key, {}).setdefault(value.quantity, value)
        if other.text != value.text:
            raise InputError(
                f"{path}, lines {other.line} and {value.line}: {headings[value.quantity]} is {other.text} and "
                f"{value.text} at {temperature} {value.texts[0]}, {frequency} {value.texts[1]}; name the specimens "
                "above their matrices, as in `Specimen | A`."
            )
    labelled = any(specimen for specimen, _, _ in tests)
    rows = [
        (
            next(iter(test.values())).line,
            [
                *([specimen] if labelled else []),
                *next(iter(test.values())).texts,
                *(test[q].text if q in test else "" for q in headings),
            ],
        )
        for (specimen, _, _), test in tests.items()
    ]
    header = [*([SPECIMEN] if labelled else []), temperature, frequency, *headings.values()]
    notes.append(
        f"matrices of {' and '.join(map(repr, headings.values()))} over {temperature} and {frequency}"
    )
    return [Block(Cells(path, header, rows, notes))]


def _listed(axes: Iterable[tuple[str, str]]) -> str:
    return " and ".join(sorted({name for axis in axes for name in axis}))


def _matrices(rows: list[Row], called: str) -> Iterable[tuple[list[_Value], tuple[str, str], dict[str, str]]]:
    """Values, names of both axes and headings by quantity of each matrix in the rows of a sheet."""
    at, end, specimen = 0, 0, condition(called).get(SPECIMEN, "")
    title = read_heading(called)
    while at < len(rows):
        size = _height(rows, at)
        if not size:
            at += 1
            continue
        above = rows[max(end, at - _ABOVE) : at]
        specimen = told_above(rows[end:at])[0].get(SPECIMEN, specimen)
        place = _first(rows[at][1])
        axes = _axes(rows[at][1], [row for _, row in rows[at + 1 : at + 1 + size]], above, place)
        names = _quantities([row for _, row in above], rows[at][1], place)
        if not names and title.is_result:
            names = {place: title}
        if axes is None or not names:
            if axes is not None and (unknown := _unknown([row for _, row in above])):
                yield [], (axes[1].name, axes[0].name), {"": unknown}
            at += 1 + size
            continue
        for unknown in (one.name for one in names.values() if one.column is None):
            yield [], (axes[1].name, axes[0].name), {"": unknown}
        across, down = axes
        turned = across.quantity != "frequency_Hz"
        values = []
        below = [cell for _, row in rows[at + 1 : at + 1 + size] for cell in row[place:]]
        for n, (line, row) in enumerate(rows[at + 1 : at + 1 + size]):
            specimen = row[0] if place > 1 and row[0] else specimen
            current = Heading("")
            for column, text in enumerate(across.texts, start=place):
                current = names.get(column, current)
                value = row[column] if column < len(row) else ""
                if not text or value.casefold() in ABSENT or current.column is None:
                    continue
                both = (text, down.texts[n]) if turned else (down.texts[n], text)
                key = (current.at.get(SPECIMEN, specimen), _number(both[0]), _number(both[1]))
                pair = match_decimal_mark(both[0], below), match_decimal_mark(both[1], below)
                values.append(_Value(line, key, pair, current.column.quantity, value))
        order = (across.name, down.name) if turned else (down.name, across.name)
        held = {one.column.quantity: one.name for one in names.values() if one.column}
        yield values, order, held
        at = end = at + 1 + size


def _height(rows: list[Row], at: int) -> int:
    """How many lines of numbers stand below a line of values of an axis; 0 if it is none."""
    head = rows[at][1]
    place = _first(head)
    values = head[place:]
    if place == 0 or sum(map(bool, values)) < 2 or not all(_is_value(cell) for cell in values if cell):
        return 0
    # Rows of single tests hold numbers below numbers too; a matrix has an axis above them, in order.
    if not _repeats_one_order(values) or any(_names_each_test(row) for _, row in rows[:at]):
        return 0
    down: list[float] = []
    for _, row in rows[at + 1 :]:
        body = row[place:]
        if any(row[: place - 1]) and not (place == 2 and _names_specimens(head[0])):
            return 0
        if len(row) > len(head) or not _is_value(row[place - 1] if len(row) >= place else ""):
            break
        if not body or not all(NUMBER.fullmatch(cell) or cell.casefold() in ABSENT for cell in body):
            break
        down.append(_number(_bare(row[place - 1])))
    # An axis repeats no value, unless specimens stand in front of it.
    return len(down) if len(down) > 1 and (place == 2 or len(set(down)) == len(down)) else 0


def _repeats_one_order(values: list[str]) -> bool:
    """Whether values rise or fall, once or again and again: the frequencies of |E*|, then those of the phase."""
    read = [_number(_bare(cell)) for cell in values if cell]
    size = next((n for n in range(1, len(read)) if read[n] == read[0]), len(read))
    first = read[:size]
    ordered = first in (sorted(set(first)), sorted(set(first), reverse=True))
    return size > 1 and ordered and len(read) % size == 0 and read == first * (len(read) // size)


def _names_each_test(row: list[str]) -> bool:
    """Whether a line names temperature, frequency and a result, as that above rows of single tests does."""
    named = [one.column.quantity for cell in row if (one := read_heading(cell)).column]
    return {"temperature_C", "frequency_Hz"} <= set(named) and any(
        name not in (*KEYS, SPECIMEN) for name in named
    )


def _bare(cell: str) -> str:
    """A number without its unit."""
    found = _AXIS_UNIT.fullmatch(cell)
    return found[1] if found else cell


def _names_specimens(cell: str) -> bool:
    column = known(cell)
    return column is not None and column.quantity in (SPECIMEN, "replicate")


def _first(head: list[str]) -> int:
    """Where the values of the axis begin: behind the last text."""
    texts = [n for n, cell in enumerate(head) if cell and not _is_value(cell)]
    if texts:
        return texts[-1] + 1
    return next((n for n, cell in enumerate(head) if cell), 0)


def _is_value(cell: str) -> bool:
    return bool(NUMBER.fullmatch(cell) or _AXIS_UNIT.fullmatch(cell))


def _number(text: str) -> float:
    return float(text.replace(",", ".").replace("−", "-"))


def _unknown(above: list[list[str]]) -> str:
    """The text that stands above a matrix in place of a quantity, with a unit."""
    return next(
        (cell for row in reversed(above) for cell in row if units_in(cell) and known(cell) is None), ""
    )


def _axes(
    head: list[str], body: list[list[str]], above: Sequence[Row], place: int
) -> tuple[_Axis, _Axis] | None:
    """The axis across and the one down; None if not even one is told."""
    across = _axis(head[place:])
    down = _axis([row[place - 1] for row in body])
    corner = [
        part.strip()
        for part in re.split(r"\s*(?:\\|\||/(?=\s|[A-Zf]\b)|↓|→)\s*", head[place - 1])
        if part.strip()
    ]
    labels = [column for text in corner if (column := known(text)) and column.quantity in KEYS]
    said = [text for text in corner if (column := known(text)) and column.quantity in KEYS]
    over = [
        cell
        for _, row in above
        for n, cell in enumerate(row)
        if n and (column := known(cell)) and column.quantity in KEYS
    ]
    if len(labels) == 2:
        first, second = said
        swap = _only_temperature(across, first, second) or _only_temperature(down, second, first)
        if not swap:
            first, second = second, first
        across, down = _named(across, first), _named(down, second)
    elif said:
        down = _named(down, said[0])
    if not across.quantity and over:
        across = _named(across, over[-1])
    for one, other in ((across, down), (down, across)):
        if one.quantity and not other.quantity:
            # With one axis named the other is known, but not whether a temperature is in degC or degF.
            name = "f (Hz)" if one.quantity in ("temperature_C", "nominal_temperature_C") else "Temperature"
            across, down = (
                (one, _Axis(name, other.texts)) if one is across else (_Axis(name, other.texts), one)
            )
            break
    if {across.quantity, down.quantity} != {"temperature_C", "frequency_Hz"}:
        return None
    return across, down


def _only_temperature(axis: _Axis, name: str, other: str) -> bool:
    """Whether an axis can only be the first of two names, for a frequency is above zero."""
    column, beside = known(name), known(other)
    cold = any(text and _number(text) <= 0.0 for text in axis.texts)
    return bool(
        cold and column and beside and beside.quantity == "frequency_Hz" and column.quantity != "frequency_Hz"
    )


def _named(axis: _Axis, name: str) -> _Axis:
    return axis if axis.quantity else _Axis(name, axis.texts)


def _axis(cells: Sequence[str]) -> _Axis:
    """Values of an axis, whose unit may stand behind each."""
    found = [_AXIS_UNIT.fullmatch(cell) for cell in cells]
    units = {match[2].strip("°º ").removeprefix("deg").strip(". ").capitalize() for match in found if match}
    texts = [match[1] if match else cell for match, cell in zip(found, cells, strict=True)]
    return _Axis(_NAMES.get(next(iter(units)), "") if len(units) == 1 else "", texts)


def _quantities(above: list[list[str]], head: list[str], place: int) -> dict[int, Heading]:
    """What the values are, by the column that it begins at; one for all may stand anywhere above, or in the corner."""
    for row in reversed(above):
        found = {n: one for n, cell in enumerate(row) if cell and (one := read_heading(cell)).is_result}
        # One that is not known ends that in front of it.
        strange = {n: Heading(cell) for n, cell in enumerate(row) if n not in found and _unknown([[cell]])}
        beside = {n: one for n, one in (found | strange).items() if n >= place}
        if found and len(beside) > 1:
            return beside
        if found:
            return {place: next(iter(found.values()))}
    corner = [read_heading(cell) for cell in head[:place]]
    told = next((one for one in corner if one.is_result), None)
    return {} if told is None else {place: told}
