"""Geometry of specimens as people give it: a CSV table, or one mapping (or JSON file) for all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.twopoint import Geometry

# Wide enough for any two-point bending rig, narrow enough to catch metres under a name in mm.
LIMITS = {
    "b_mm": Limits(2, 200, "give the width of the head in mm"),
    "B_mm": Limits(2, 300, "give the width of the foot in mm"),
    "e_mm": Limits(2, 200, "give the thickness in mm"),
    "h_mm": Limits(20, 1000, "give the height in mm"),
    "mass_kg": Limits(1e-3, 20, "give the mass of the specimen in kg"),
    "mobile_mass_kg": Limits(0, 20, "give the mass of the mobile equipment in kg"),
}


def read_geometry(source: str | Path | Mapping[str, Any], specimens: Iterable[str]) -> dict[str, Geometry]:
    """Geometry of each named specimen.

    source: path of a CSV table (`specimen` and the keys of LIMITS), or a mapping of these keys that
    holds for all specimens, or the path of a JSON file with such a mapping.
    """
    specimens = list(dict.fromkeys(specimens))
    if isinstance(source, Mapping):
        return dict.fromkeys(specimens, _from_mapping(source, "geometry"))
    if Path(source).suffix.lower() == ".json":
        return dict.fromkeys(specimens, _from_mapping(read_json(source), str(source)))
    known = _from_table(source)
    for specimen in specimens:
        if specimen not in known:
            raise InputError(
                f"{source}: specimen {specimen!r} has no geometry (known: {', '.join(known)}); "
                "add a line for it."
            )
    return {specimen: known[specimen] for specimen in specimens}


def require_within(geometry: Geometry, box: Sequence[float]) -> None:
    """Refuse a specimen that a layer in the box (length, width, height) [m] cannot hold in full."""
    room = {"h": ("high", "long", box[0]), "e": ("thick", "wide", box[1])}
    for name, (extent, direction, size) in room.items():
        if getattr(geometry, name) > size * (1.0 + 1e-9):
            raise InputError(
                f"the specimen is {1e3 * getattr(geometry, name):g} mm {extent}, but the box only "
                f"{1e3 * size:g} mm {direction}; lower {name}_mm or pour into a larger box."
            )


def _from_table(path: str | Path) -> dict[str, Geometry]:
    table = read_csv(path)
    table.require(["specimen", *LIMITS])
    values = {name: table.numbers(name, limits) for name, limits in LIMITS.items()}
    known: dict[str, Geometry] = {}
    for row, specimen in enumerate(table.text("specimen")):
        if specimen in known:
            raise table.error(row, f"specimen {specimen!r} appears twice; keep one line for it.")
        try:
            known[specimen] = _in_metres({name: float(column[row]) for name, column in values.items()})
        except InputError as error:
            raise table.error(row, str(error)) from None
    return known


def _from_mapping(mapping: Any, name: str) -> Geometry:
    if not isinstance(mapping, Mapping):
        raise InputError(f"{name}: not a mapping; give {', '.join(LIMITS)}.")
    for key in [*LIMITS, *mapping]:
        if key not in mapping or key not in LIMITS:
            problem = "is missing" if key in LIMITS else "is not known"
            raise InputError(f"{name}: key {key!r} {problem}; give exactly {', '.join(LIMITS)}.")
    for key, limits in LIMITS.items():
        value = mapping[key]
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not limits.low <= value <= limits.high:
            raise InputError(
                f"{name}: {key} = {value!r} is not a number from {limits.low:g} to {limits.high:g}; "
                f"{limits.mend}."
            )
    try:
        return _in_metres(mapping)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def _in_metres(values: Mapping[str, float]) -> Geometry:
    b, foot, e, h = (values[name] * 1e-3 for name in ("b_mm", "B_mm", "e_mm", "h_mm"))
    return Geometry(b, foot, e, h, mass=values["mass_kg"], mobile_mass=values["mobile_mass_kg"])
