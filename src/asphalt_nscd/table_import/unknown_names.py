"""Names of quantities in words that `words.toml` does not hold, and tables in which the user says what they are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import choice, joined
from asphalt_nscd.table_import.cells import Row, Sheet
from asphalt_nscd.table_import.decimals import Number
from asphalt_nscd.table_import.heading import known, quantity_of, read_heading, strip_conditions
from asphalt_nscd.table_import.quantities import LONGEST_NAME, MEASURED, derived, recognise, unit_in, units_in
from asphalt_nscd.table_import.understand import WORDS_OF

# What a test needs: what an unknown name with such a unit most likely is, and all that give it.
_NEEDED = {
    "temperature_C": ("temperature_C", "nominal_temperature_C"),
    "frequency_Hz": ("frequency_Hz", "nominal_frequency_Hz"),
    "E_MPa": ("E_MPa", "E1_MPa", "E2_MPa", "F0_N"),
    "phase_deg": ("phase_deg", "tan_delta", "psi_deg", "E2_MPa"),
}
MOST_OFFERED = 4  # names for one quantity
_UNIT = re.compile(r"[\s_]*(?:[(\[{]([^)\]}]*)[)\]}]|[,/]\s*(\S+)|\s(\S{2,})|\s?([°º]\s?[CF]?))(?=\s|$)")
_NUMBERED = re.compile(r"[\s_.#-]*(?:\d{1,3}|(?<=[\s_-])[A-Z]\d{0,3})$")


def unknown_names(sheets: Sequence[Sheet]) -> dict[str, dict[str, str]]:
    """For each quantity that no name in a file gives, the unknown names whose unit fits it, with this unit."""
    names = [name for sheet in sheets for name in _names(sheet.rows)]
    given = {quantity_of(strip_conditions(name)) for name in names}
    given |= {quantity_of(key) for name in names for key in read_heading(name).at}
    missing = [quantity for quantity, ways in _NEEDED.items() if given.isdisjoint(ways)]
    found: dict[str, dict[str, str]] = {}
    unknown = [parted for name in names if known(strip_conditions(name)) is None for parted in _parted(name)]
    for name, unit in unknown:
        for quantity in missing:
            if unit in MEASURED[quantity][1] and not quantity_of(name):
                found.setdefault(quantity, {}).setdefault(name, unit)
    return {quantity: found[quantity] for quantity in missing if quantity in found}


def with_names(error: InputError, path: Path, sheets: Sequence[Sheet]) -> InputError:
    """The refusal of a file, or one that says which of its names are unknown and how to say what they are."""
    found = unknown_names(sheets)
    if not found or any(derived(cell) for sheet in sheets for _, row in sheet.rows for cell in row):
        return error
    cues, unknown = [], []
    for quantity, names in found.items():
        offered = list(names.items())[:MOST_OFFERED]
        stem = quantity.rpartition("_")[0]
        cues.append(" or ".join(f'--column {stem}_{unit}="{name}"' for name, unit in offered))
        unknown += [repr(name) for name, _ in offered]
    verb = "is" if len(unknown) == 1 else "are"
    way = choice(f"say {' '.join(cues)}", "choose in the menus below what they hold")
    ours = joined([WORDS_OF[quantity] for quantity in found])
    return type(error)(f"{path}: {joined(unknown)} {verb} not known; {way}, or write {ours} for them.")


def named(sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Sheet]:
    """The sheets with our words for the names that the user chose; empty if one is not there, or has another unit."""
    cells = [cell for sheet in sheets for _, row in sheet.rows for cell in row]
    texts = {cell for cell in cells if not isinstance(cell, Number)}
    ours: dict[str, str] = {}
    for wanted, name in chosen.items():
        column = recognise(wanted)
        begins = re.compile(rf"{re.escape(name)}(?![^\W\d_])")
        these = {name} & texts or {text for text in texts if begins.match(text)}
        if column is None or column.unit is None or derived(name) or not these:
            return []
        word = wanted.rpartition("_")[0] if column.unit else wanted
        for text in these:
            told = [unit for unit in units_in(text) if unit in MEASURED[column.quantity][1]]
            if told not in ([], [column.unit]):
                return []
            rest = text[len(name) :]
            behind = not column.unit or column.unit in units_in(rest)
            ours[text] = f"{'|E*|' if word == 'E' else word}{rest}{'' if behind else f' ({column.unit})'}"
    if not ours:
        return []
    notes = [f"{name!r} taken for {wanted}, as you chose" for wanted, name in chosen.items()]
    return [
        replace(
            sheet,
            rows=[(line, [ours.get(cell, cell) for cell in row]) for line, row in sheet.rows],
            notes=[*sheet.notes, *notes],
        )
        for sheet in sheets
    ]


def _names(rows: Sequence[Row]) -> Iterator[str]:
    """Texts that may name something, with their unit where this stands in a line below."""
    for (_, row), (_, below) in zip(rows, [*rows[1:], (0, [])], strict=True):
        units = [units_in(cell) == [unit_in(f"x ({cell})")] for cell in below]
        line_of_units = sum(units) > 1 and not any(isinstance(cell, Number) for cell in below)
        for n, cell in enumerate(row):
            if len(cell) > LONGEST_NAME or units_in(cell) == [unit_in(f"x ({cell})")] or derived(cell):
                continue
            unit = f" ({below[n].strip('()[]{} ')})" if line_of_units and n < len(below) and units[n] else ""
            yield f"{cell}{unit}"


def _parted(text: str) -> Iterator[tuple[str, str]]:
    """An unknown name without unit and number of a specimen, and its unit; nothing if it has no unit."""
    for found in _UNIT.finditer(text):
        unit = unit_in(f"x ({next(filter(None, found.groups()), '')})")
        name = _NUMBERED.sub("", text[: found.start()]).strip(" ,;:_-")
        if unit and re.search(r"[^\W\d_]", name):
            yield name, unit
            return
