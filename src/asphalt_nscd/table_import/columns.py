"""The one column of a quantity: as the user named it, of several that agree, and with its unit."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import choice
from asphalt_nscd.table_import.cells import Cells, UnreadNames
from asphalt_nscd.table_import.decimals import number
from asphalt_nscd.table_import.heading import strip_conditions
from asphalt_nscd.table_import.quantities import MEASURED, Meaning, derived, recognise, unit_in
from asphalt_nscd.table_import.words import SAY

Place = tuple[int, Meaning]  # of a column, and what it holds
_LARGEST_RADIAN = 1.6  # of a phase; a larger one is in degrees
_WARMEST = 60.0  # degC; three temperatures up to 60 F are 15 degC at most, and nobody's campaign
_LEAST_TEMPERATURES = 3


def name_with_unit(name: str, column: Meaning) -> str:
    """Our name of a quantity with the unit that the user's column has: E_GPa."""
    return f"{name.rpartition('_')[0]}_{column.unit}" if column.unit else name


def _is_angular(name: str) -> bool:
    return any(word in name.casefold() for word in SAY["angular"])


def column_cue(wanted: str, name: str) -> str:
    """How a user says that the column of a name holds what is wanted."""
    return choice(f'with --column {wanted}="{name}"', "in its menu below")


def _named(wanted: str) -> str:
    """How a refusal of the column chosen for `wanted` begins; empty on the page."""
    return choice(f"--column {wanted}: ", "")


def chosen_columns(cells: Cells, chosen: Mapping[str, str]) -> dict[str, list[Place]]:
    """The columns that the user named with --column, by our names; `chosen` has them by what they hold."""
    found: dict[str, list[Place]] = {}
    for wanted, name in chosen.items():
        column = recognise(wanted)
        if column is None or column.unit is None:
            names = ", ".join(MEASURED)
            raise InputError(f"{_named(wanted)}not known; give one of {names}, with the unit of your column.")
        # A line of units below the names was put behind them.
        places = [n for n, header in enumerate(cells.header) if header == name] or [
            n
            for n, header in enumerate(cells.header)
            if re.fullmatch(re.escape(name) + r" \([^)]*\)", header)
        ]
        if len(places) != 1:
            several = (
                f"{len(places)} columns are called {name!r}; rename one" if places else f"no column {name!r}"
            )
            raise UnreadNames(f"{cells.path}: {several}; its columns are {', '.join(cells.header)}.")
        if kind := derived(cells.header[places[0]]):
            raise InputError(
                f"{cells.path}: {_named(wanted)}column {name!r} holds "
                + ("logarithms" if kind == "logarithm" else "values reduced to one temperature")
                + "; give a column of what was measured."
            )
        _require_unit(cells, places[0], wanted, column)
        found[column.quantity] = [(places[0], column)]
    return found


def _require_unit(cells: Cells, place: int, wanted: str, column: Meaning) -> None:
    """Refuse a unit that the name of the column contradicts."""
    name, units = cells.header[place], MEASURED[column.quantity][1]
    told = unit_in(strip_conditions(name))
    bracketed = re.search(r"[(\[{][^)\]}]*[)\]}]\s*$", name)
    if not told or not units or told == column.unit or (told not in units and not bracketed):
        return
    if told not in units:
        raise InputError(
            f"{cells.path}: {_named(wanted)}column {name!r} is in {told}, which is no unit of {column.quantity}; "
            "name another column, or correct its name."
        )
    if units[told] != (column.factor, column.offset):
        own = f"{column.quantity.rpartition('_')[0]}_{told}"
        way = choice(f'write --column {own}="{name}"', "choose so in its menu below")
        raise InputError(
            f"{cells.path}: {_named(wanted)}column {name!r} says {told}; {way}, which is then converted, or correct "
            "the name of the column."
        )


def one_of(cells: Cells, name: str, places: list[Place]) -> tuple[Place, list[str], set[int]]:
    """The column of a quantity, one of several that must agree; notes on how it was found, and its copies."""
    place, notes, copies = places[0], [], set()
    if len(places) > 1:
        place = _agreeing(cells, name, places)
        others = [other for other, _ in places if other != place[0]]
        copies = set(others)
        same = ", ".join(repr(cells.header[other]) for other in others)
        twice = all(cells.header[other] == cells.header[place[0]] for other in others)
        notes.append(
            f"column {cells.header[place[0]]!r} stands there twice with the same values"
            if twice
            else f"column {cells.header[place[0]]!r} is read; the same stands in {same}"
        )
    called = cells.header[place[0]]
    if name == "frequency_Hz" and place[1].unit == "Hz" and _is_angular(called):
        raise InputError(
            f"{cells.path}: column {called!r}: an angular frequency is in rad/s; name it f (Hz) or omega (rad/s)."
        )
    if place[1].unit is None:
        column, why = _assumed(cells, place)
        notes.append(f"{called!r} does not say its unit: {column.unit} taken, {why}")
        place = place[0], column
    return place, notes, copies


def _agreeing(cells: Cells, name: str, places: list[Place]) -> Place:
    """The best of several columns that hold the same in each row, to the digits written; refused if they do not."""
    known = [place for place in places if place[1].unit is not None]

    def coarseness(place: Place) -> tuple[bool, float]:
        """A key, least for the column in our own unit, and among alike for that of most digits."""
        halves = [_value(row[place[0]], place[1])[1] for _, row in cells.rows]
        return place[1].converts, sum(halves)

    best = min(known or places, key=coarseness) if MEASURED[name][1] else places[0]
    for other in places:
        for line, row in cells.rows:
            if row[best[0]] == row[other[0]] and (other[1].unit in (None, best[1].unit)):
                continue
            if MEASURED[name][1] and (best[1].unit is None) == (other[1].unit is None):
                (a, half_a), (b, half_b) = _value(row[best[0]], best[1]), _value(row[other[0]], other[1])
                # 4.0 degC and 39 degF are one temperature, each rounded by half of its last digit.
                rounding = half_a + half_b if best[1].unit != other[1].unit else 0.0
                if abs(a - b) <= rounding + 1e-9 * abs(a):
                    continue
            raise _contradiction(cells, name, (best, other), line, (row[best[0]], row[other[0]]))
    return best


def _value(cell: str, meaning: Meaning) -> tuple[float, float]:
    """Number of a cell in our unit, and half of its last digit; NaN for none, which agrees with nothing."""
    value = number(cell)
    if value is None:
        return float("nan"), 0.0
    mantissa, _, exponent = cell.replace(",", ".").casefold().partition("e")
    # Clipped, because 10.0 ** 999999 overflows, and a cell may hold 1e-999999.
    digits = len(mantissa.partition(".")[2]) - int(np.clip(int(exponent or 0), -200, 200))
    return value * meaning.factor + meaning.offset, 0.5 * 10.0**-digits * meaning.factor


def _contradiction(
    cells: Cells, name: str, places: tuple[Place, Place], line: int, texts: tuple[str, str]
) -> InputError:
    """The refusal of two columns for one quantity that differ in `line`, where they hold `texts`."""
    (first, column), (second, _) = sorted(places)
    a, b = texts if places[0][0] == first else texts[::-1]
    differ = f"in line {line} they hold {a or 'nothing'} and {b or 'nothing'}"
    one, other = cells.header[first], cells.header[second]
    if one == other:
        return InputError(
            f"{cells.path}: column {one!r} appears twice; remove one or rename it, or write two specimens below each "
            f"other with a column specimen ({differ})."
        )
    return InputError(
        f"{cells.path}: columns {one!r} and {other!r} may each be {name}; say which "
        f"{column_cue(name_with_unit(name, column), one)}, or remove the others ({differ})."
    )


def _assumed(cells: Cells, place: Place) -> tuple[Meaning, str]:
    """A column that says no unit with the only one that its values leave, and why; else refused, as any modulus is."""
    at, column = place
    name, quantity = cells.header[at], column.quantity
    values = {value for _, row in cells.rows if (value := number(row[at])) is not None}
    if quantity == "frequency_Hz" and not _is_angular(name):
        return Meaning(quantity, "Hz"), "as a frequency has"
    if quantity == "phase_deg" and max(map(abs, values), default=0.0) > _LARGEST_RADIAN:
        return Meaning(quantity, "deg"), "because no phase in rad is that large"
    warmest = max(values, default=_WARMEST + 1.0)
    if quantity == "temperature_C" and len(values) >= _LEAST_TEMPERATURES and warmest <= _WARMEST:
        return Meaning(quantity, "C"), f"because {warmest:g} degF would be too cold for the warmest test"
    stem, _, unit = quantity.rpartition("_")
    raise InputError(
        f"{cells.path}: column {name!r} does not say its unit; write it after the name, as in {stem} ({unit})"
        + choice(".", ", or choose it in its menu below.")
    )
