"""The spheres of a study and their box: the paper's, scaled to another specimen or made from a sieve table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.tension import Cylinder
from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.reporting.tables.table2 import PERCENT, SIEVE, counts_of_grading
from asphalt_nscd.table_import.cells import read_cells
from asphalt_nscd.table_import.decimals import decimal_mark, number
from asphalt_nscd.table_import.quantities import SIEVES, recognise

PAPER_COUNTS = pd.Series({2.0: 11798, 4.0: 1588, 6.3: 492, 8.0: 211, 10.0: 71})  # Table 2, by mm
SMALLEST_MM = 2.0  # of the paper's spheres; what is finer belongs to the mastic
COARSER = (
    2.0  # spheres of a cylinder, so that one of 100 x 150 mm takes about as many as the paper's trapezoid
)
CELLS_FILLED = 2448 / 8000  # of the lattice from which the paper's spheres are poured
MOST_SPHERES = 200_000


@dataclass(frozen=True)
class Spheres:
    """The spheres of a study and their box.

    `counts` has the number by diameter [mm]; `box` is length, width, height [m] and holds them and the specimen. What
    is finer than `smallest_mm` belongs to the mastic.
    """

    counts: pd.Series
    box: tuple[float, float, float]
    smallest_mm: float = SMALLEST_MM


def spheres_for(shape: Shape, grading: pd.Series | None = None) -> Spheres:
    """Spheres of the paper's volume per volume of specimen, of its sizes or of a sieve curve, and their box.

    In a cylinder the paper's sizes are twice as large. `grading` is per cent passing by sieve [mm].
    """
    coarser = COARSER if isinstance(shape, Cylinder) else 1.0
    room, smallest = _block(shape) / _block(PAPER), SMALLEST_MM * coarser
    if grading is None:
        counts = (PAPER_COUNTS * room / coarser**3).round().astype(int)
        counts.index = counts.index * coarser
    else:
        curve = np.array(grading.index, np.float64), np.array(grading, np.float64)
        # A million, so that rounding to whole spheres does not show in their mean volume.
        shares = counts_of_grading(*curve, smallest, 1_000_000)
        mean = float((shares * shares.index**3).sum()) / 1e6
        total = round(room * float((PAPER_COUNTS * PAPER_COUNTS.index**3).sum()) / mean)
        counts = counts_of_grading(*curve, smallest, total)
    counts = counts[counts > 0]
    if counts.sum() > MOST_SPHERES:
        raise InputError(
            f"the specimen takes {counts.sum()} spheres, more than {MOST_SPHERES}; give a smaller one."
        )
    return Spheres(counts, _box(shape, counts), smallest)


def _block(shape: Shape) -> float:
    return shape.h * shape.thickness * shape.width


def _box(geometry: Shape, counts: pd.Series) -> tuple[float, float, float]:
    """A box [m] as long and wide as the specimen, as high as `random_lattice` needs to be as loose as the paper's."""
    diameter = counts.index.to_numpy(float) * 1e-3
    if diameter.max() > geometry.thickness:
        raise InputError(
            f"spheres of {1e3 * diameter.max():g} mm do not fit into a specimen {1e3 * geometry.thickness:g} mm thick; "
            "give a thicker one or a finer grading."
        )
    # 0.29 / 0.01 comes out as 28.999...; rounding must not cost a row of cells.
    across = [int(np.floor(size / diameter.max() + 1e-9)) for size in (geometry.h, geometry.thickness)]
    # The eight octants of a cell hold a sphere each, where these are half as large as the largest.
    shared = 2.0 * diameter <= diameter.max()
    number_of = counts.to_numpy()
    cells = number_of[~shared].sum() + np.ceil(number_of[shared].sum() / 8)
    layers = int(np.ceil(cells / CELLS_FILLED / (across[0] * across[1]) - 1e-9))
    return geometry.h, geometry.thickness, round(layers * float(diameter.max()), 6)


def read_grading(path: str | Path, sheet: str | None = None) -> pd.Series:
    """Read a sieve curve, per cent passing by sieve [mm], from any table that `read_cells` reads."""
    cells = read_cells(path, sheet)
    try:
        columns = [recognise(name, SIEVES) for name in cells.header]
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    places = {one.quantity: place for place, one in enumerate(columns) if one}
    if sum(map(bool, columns)) != len(SIEVES) or set(places) != set(SIEVES):
        raise InputError(
            f"{path}: give two columns, sieve (mm) and passing (%); found {', '.join(cells.header)}."
        )
    mark = decimal_mark(str(path), ((line, row[n]) for line, row in cells.rows for n in places.values()))
    curve: dict[float, float] = {}
    for line, row in cells.rows:
        values = []
        for place, limits in ((places["diameter_mm"], SIEVE), (places["passing_percent"], PERCENT)):
            name, column, value = cells.header[place], columns[place], number(row[place], mark)
            if column is None or column.unit is None:
                raise InputError(
                    f"{path}: column {name!r} does not say its unit; write sieve (mm), passing (%)."
                )
            values.append(np.nan if value is None else value * column.factor)
            if not limits.low <= values[-1] <= limits.high:
                raise InputError(f"{path}, line {line}: {name} is {row[place]!r}; {limits.mend}.")
        if values[0] in curve:
            raise InputError(f"{path}, line {line}: sieve {values[0]:g} mm appears twice; keep one.")
        curve[values[0]] = values[1]
    grading = pd.Series(curve)
    if grading.max() <= 1.0:
        raise InputError(
            f"{path}: passes at most {grading.max():g} %, which looks like fractions; give percent."
        )
    try:
        counts_of_grading(
            np.array(grading.index, np.float64), np.array(grading, np.float64), SMALLEST_MM, 1000
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return grading
