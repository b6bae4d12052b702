"""Sweeps of which one half contradicts the other: which half is wrong, the other specimens tell.

Two wrong readings of four leave their own isotherm as well ordered as the other two, so causality may take out either
pair. It stays a matter of causality that something is wrong. Which tests it is, is asked of the level that the
specimen has on its other isotherms against the other specimens.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening.within_isotherm import SCATTER, blocks

FAR = 6.0  # usual departures of a table, beyond which a test is off the level of its specimen
ACCUSED = 4.5  # the same in a sweep from which causality takes out tests that are clearly on the level
NEAR = 0.5  # share of the largest departure of a sweep, up to which a test is held to be on the level
# The same for a test that is clearly on it. Where causality takes out none, all others must be: what is merely soft or
# slow departs smoothly.
CLEARLY_NEAR = 0.35
LEAST_SPECIMENS = 3  # of two, neither is the odd one


def put_right(observed: Observations, out: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Tests (n,) to leave out, and tests (n,) of turned sweeps, of which others are left out than causality says.

    `out` (n,) is what causality takes out. A sweep is turned if that is half of it or more, or holds only tests on the
    level of their specimen, or one clearly on it; and if tests that it leaves are far off, as half of it is at most.
    """
    now, turned = out.copy(), np.zeros(observed.size, bool)
    block, apart = blocks(observed), _level_distance(observed)
    for one in np.unique(block[out]):
        rows = np.flatnonzero(block == one)
        distance = apart[rows]
        largest = distance.max()
        off = distance > NEAR * largest
        accused = distance[out[rows]]
        wrongly = accused.min() < CLEARLY_NEAR * largest or accused.max() <= NEAR * largest
        unsure = wrongly or 2 * np.count_nonzero(out[rows]) >= rows.size
        clear = largest > (ACCUSED if wrongly else FAR) and 2 * np.count_nonzero(off) <= rows.size
        if unsure and clear and (off & ~out[rows]).any():
            now[rows], turned[rows] = off, True
    return now, turned


def masked(observed: Observations, out: NDArray[np.bool_], doubtful: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tests (n,) to leave out besides: they hide each other in a sweep from which causality takes out none.

    Of four tests causality can accuse but one. Two of a sweep at least must be far off the level of their specimen, one
    of them `doubtful` (causality might accuse it), and all others clearly on it. The worst sweep is judged first, since
    tests left out no longer count for the levels of others, as those that are `out` do not.
    """
    block, found = blocks(observed), np.zeros(observed.size, bool)
    sweeps = [np.flatnonzero(block == one) for one in np.unique(block[doubtful])]
    while sweeps:
        apart = _level_distance(observed, out | found)
        clear = [
            rows
            for rows in sweeps
            if not (out | found)[rows].any()
            and _two_stand_out(apart[rows], doubtful[rows])
            and np.unique(observed.specimen[observed.isotherm == observed.isotherm[rows[0]]]).size
            >= LEAST_SPECIMENS
        ]
        if not clear:
            break
        worst = max(clear, key=lambda rows: apart[rows].max())
        found[worst] = apart[worst] > NEAR * apart[worst].max()
    return found


def _two_stand_out(distance: NDArray[np.float64], doubtful: NDArray[np.bool_]) -> bool:
    """Whether two tests or more, half a sweep at most, are far off the level, one `doubtful`, and the others on it."""
    largest = distance.max()
    off = distance > NEAR * largest
    some = 1 < np.count_nonzero(off) <= distance.size // 2 and bool((off & doubtful).any())
    return bool(some and largest > FAR and distance[~off].max() < CLEARLY_NEAR * largest)


def _level_distance(observed: Observations, out: NDArray[np.bool_] | None = None) -> NDArray[np.float64]:
    """How far (n,) a test is off the other specimens at its condition, in usual departures of the table.

    What the specimen is off by on its other isotherms, a level and a phase, is taken off first. A sweep with a
    test that is `out` (n,) is no reference. Zero where there is no other specimen, or no other isotherm.
    """
    logarithm = observed.logarithm
    values = np.column_stack([logarithm.real, logarithm.imag])
    apart = np.full(values.shape, np.nan)
    # A sweep is asked as a whole or not at all: specimens differ, so another reference would be a step.
    block = blocks(observed)
    cells = observed.cell if out is None else np.where(np.isin(block, block[out]), -1, observed.cell)
    for row, (cell, specimen) in enumerate(zip(observed.cell, observed.specimen, strict=True)):
        others = (cells == cell) & (observed.specimen != specimen)
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
    # A table that repeats almost exactly would make every test far off.
    usual = (
        np.maximum(1.4826 * np.median(np.abs(levelled[known]), axis=0), SCATTER) if known.any() else SCATTER
    )
    return np.asarray((np.abs(levelled) / usual).max(axis=1))
