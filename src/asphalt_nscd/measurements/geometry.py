"""Geometry of specimens as people give it: a CSV table, or one mapping (or JSON file) for all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.fourpoint import T321
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.tension import AMPT
from asphalt_nscd.measurements.twopoint import PAPER, Geometry

USUAL: dict[str, Shape] = {shape.test: shape for shape in (PAPER, AMPT, T321)}  # specimens, one for each test
SHAPES: dict[str, type[Shape]] = {test: type(shape) for test, shape in USUAL.items()}
LIMITS = Geometry.limits  # of those measured in bending, which alone are reduced here from forces


def shape_of(attributes: Mapping[str, Any]) -> Shape:
    """The geometry that `Shape.attributes` of a file said."""
    shape = SHAPES[attributes["geometry"]]
    return shape(**{field.name: attributes[field.name] for field in fields(shape)})  # type: ignore[arg-type]


def test_of(mapping: Mapping[str, Any]) -> str:
    """The test whose first key a mapping of mm and kg has, else two-point bending."""
    return next(
        (test for test, shape in SHAPES.items() if next(iter(shape.limits)) in mapping), Geometry.test
    )


def read_shape(source: str | Path | Mapping[str, Any]) -> Shape:
    """The specimen to simulate, from a mapping or a JSON file with the keys of one of SHAPES, or from a CSV table.

    The keys say which: d_mm is of a cylinder in tension-compression, L_mm of a prism in four-point bending, b_mm of a
    trapezoid in two-point bending. Of a table it is the trapezoid in the row called `specimen`.
    """
    if isinstance(source, Mapping):
        return _parse_shape(source, "geometry")
    if Path(source).suffix.lower() == ".json":
        return _parse_shape(read_json(source), str(source))
    return read_geometry(source, ["specimen"])["specimen"]


def read_geometry(source: str | Path | Mapping[str, Any], specimens: Iterable[str]) -> dict[str, Geometry]:
    """Geometry of each named specimen, by name.

    `source` is a CSV table (`specimen` and the keys of LIMITS), or a mapping of these keys that holds for all
    specimens, or a JSON file with such a mapping.
    """
    specimens = list(dict.fromkeys(specimens))
    if isinstance(source, Mapping):
        return dict.fromkeys(specimens, _trapezoid(source, "geometry"))
    if Path(source).suffix.lower() == ".json":
        return dict.fromkeys(specimens, _trapezoid(read_json(source), str(source)))
    known = _read_geometries(source)
    for specimen in specimens:
        if specimen not in known:
            raise InputError(
                f"{source}: specimen {specimen!r} has no geometry (known: {', '.join(known)}); "
                "add a line for it."
            )
    return {specimen: known[specimen] for specimen in specimens}


def require_within(shape: Shape, box: Sequence[float]) -> None:
    """Refuse a specimen that a layer in the box (3,) [m] cannot hold in full; says in which direction."""
    for wanted, extent, direction, size in (
        (shape.h, "high", "long", box[0]),
        (shape.thickness, "thick", "wide", box[1]),
    ):
        # Millimetres become metres by a product, which errs in the last bit for 36 or 51 of them.
        if wanted > size * (1.0 + 1e-9):
            name = next(key for key, value in shape.keys().items() if np.isclose(1e-3 * value, wanted))
            raise InputError(
                f"the specimen is {1e3 * wanted:g} mm {extent}, but the box only "
                f"{1e3 * size:g} mm {direction}; lower {name} or pour into a larger box."
            )


def require_joined(shape: Shape, area: str) -> None:
    """Refuse bonds by an area other than facets where clamps lie between the ends, since they do not join them."""
    if area != "facets" and len(shape.plates) > 2:
        raise InputError(
            f"{shape.test} clamps the specimen between its ends, where bonds by area {area!r} do not join it; give "
            "area facets."
        )


def _read_geometries(path: str | Path) -> dict[str, Geometry]:
    """Geometry of each specimen in a CSV table, by its name."""
    table = read_csv(path)
    table.require(["specimen", *LIMITS])
    values = {name: table.numbers(name, limits) for name, limits in LIMITS.items()}
    known: dict[str, Geometry] = {}
    for row, specimen in enumerate(table.text("specimen")):
        if specimen in known:
            raise table.error(row, f"specimen {specimen!r} appears twice; keep one line for it.")
        try:
            known[specimen] = Geometry.of({name: float(column[row]) for name, column in values.items()})
        except InputError as error:
            raise table.error(row, str(error)) from None
    return known


def _trapezoid(mapping: Any, name: str) -> Geometry:
    shape = _parse_shape(mapping, name, Geometry)
    assert isinstance(shape, Geometry)
    return shape


def _parse_shape(mapping: Any, name: str, kind: type[Shape] | None = None) -> Shape:
    """The shape of `kind`, or else of the kind whose first key the mapping [mm, kg] has; `name` begins a refusal."""
    if not isinstance(mapping, Mapping):
        raise InputError(f"{name}: not a mapping; give {', '.join((kind or Geometry).limits)}.")
    kind = kind or SHAPES[test_of(mapping)]
    for key in [*kind.limits, *mapping]:
        if key not in mapping or key not in kind.limits:
            problem = "is missing" if key in kind.limits else "is not known"
            raise InputError(f"{name}: key {key!r} {problem}; give exactly {', '.join(kind.limits)}.")
    for key, limits in kind.limits.items():
        value = mapping[key]
        number = isinstance(value, Real) and not isinstance(value, bool)
        if not number or not limits.low <= value <= limits.high:
            said = f"{value:g}" if isinstance(value, float) else repr(value)  # no float holds every int
            raise InputError(
                f"{name}: {key} = {said} is not a number from {limits.low:g} to {limits.high:g}; "
                f"{limits.mend}."
            )
    try:
        return kind.of(mapping)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
