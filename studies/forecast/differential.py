"""The differential scheme: what a mix of spheres would be whose grains never touch (McLaughlin 1977)."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.forecasting.rivals import BINDER_BULK

FINE = 1000  # steps: |E*| of 60 is off by up to 5 %
RIGDEN = 0.35
"""Voids of dry compacted filler, mostly 28 to 38 % (EN 13043). Binder in them moves with the grains."""


def differential(recipe: Recipe, steps: int = 60, rigden: float = 0.0) -> np.ndarray:
    """E* (n,) [Pa]: grains of each level, then voids, added bit by bit to what is there.

    `rigden` are voids of the finest level, of its compacted volume, whose binder counts as grains.
    """
    young, stone = recipe.binder_modulus(), recipe.aggregate
    bulk = np.full(young.shape, BINDER_BULK, complex)
    shear = 3.0 * bulk * young / (9.0 * bulk - young)
    parts = [(level.fraction, stone.bulk, stone.shear) for level in levels_of(recipe)]
    parts[0] = (parts[0][0] / (1.0 - rigden), *parts[0][1:])
    for fraction, own_bulk, own_shear in [*parts, (recipe.voids, 0.0, 0.0)]:
        step = -np.log(1.0 - fraction) / steps
        for _ in range(steps):
            around = shear * (9.0 * bulk + 8.0 * shear) / (6.0 * (bulk + 2.0 * shear))
            # In compliance, since a void in a nearly incompressible matrix is a stiff equation.
            soft = 1.0 / bulk
            flow = 4.0 / 3.0 * shear
            change = step * (own_bulk * soft - 1.0) * (1.0 + flow * soft) / (own_bulk + flow)
            shear = shear + step * (own_shear - shear) * (shear + around) / (own_shear + around)
            bulk = 1.0 / (soft - change)
    return 9.0 * bulk * shear / (3.0 * bulk + shear)
