"""Sweeps of which one half contradicts the other: which half is wrong, the other specimens tell.

Two wrong readings of four leave their own isotherm as well ordered as the other two, so causality may take out either
pair. It stays a matter of causality that something is wrong. Which tests it is, is asked of the level that the
specimen has on its other isotherms against the other specimens.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.within_isotherm import SCATTER, blocks

FAR = 6.0  # usual departures of a table, beyond which a test is off the level of its specimen
NEAR = 0.5  # share of the largest departure of a sweep, below which a test is held to be on the level


def put_right(observed: Observations, out: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which half of a sweep is wrong, by the level that the specimen has on its other isotherms.

    A sweep is turned where the tests that causality takes out are half of it, or all on the level of their
    specimen, while some others are far off it, and these are no more than half.

    Parameters
    ----------
    observed : Observations
        Measured tests.
    out : ndarray of bool (n,)
        Those that causality takes out.

    Returns
    -------
    ndarray of bool (n,)
        Tests to leave out.
    ndarray of bool (n,)
        Tests of sweeps where the others are left out than causality said.
    """
    now, turned = out.copy(), np.zeros(observed.size, bool)
    block, apart = blocks(observed), _from_level(observed)
    for one in np.unique(block[out]):
        rows = np.flatnonzero(block == one)
        distance = apart[rows]
        off = distance > NEAR * distance.max()
        unsure = 2 * np.count_nonzero(out[rows]) >= rows.size or not (off & out[rows]).any()
        clear = distance.max() > FAR and 2 * np.count_nonzero(off) <= rows.size
        if unsure and clear and (off & ~out[rows]).any():
            now[rows], turned[rows] = off, True
    return now, turned


def _from_level(observed: Observations) -> NDArray[np.float64]:
    """How far (n,) a test is off the other specimens at its condition, in usual departures of the table.

    What the specimen is off by on its other isotherms, a level and a phase, is taken off first. Zero where no other
    specimen was tested.
    """
    logarithm = observed.logarithm
    values = np.column_stack([logarithm.real, logarithm.imag])
    apart = np.full(values.shape, np.nan)
    for row, (cell, specimen) in enumerate(zip(observed.cell, observed.specimen, strict=True)):
        others = (observed.cell == cell) & (observed.specimen != specimen)
        if others.any():
            apart[row] = values[row] - np.median(values[others], axis=0)
    known = np.isfinite(apart[:, 0])
    levelled = np.zeros(values.shape)
    for specimen, isotherm in np.unique(
        np.column_stack([observed.specimen, observed.isotherm])[known], axis=0
    ):
        here = known & (observed.specimen == specimen) & (observed.isotherm == isotherm)
        elsewhere = known & (observed.specimen == specimen) & (observed.isotherm != isotherm)
        if elsewhere.any():
            levelled[here] = apart[here] - np.median(apart[elsewhere], axis=0)
    usual = (
        np.maximum(1.4826 * np.median(np.abs(levelled[known]), axis=0), SCATTER) if known.any() else SCATTER
    )
    return np.asarray((np.abs(levelled) / usual).max(axis=1))
