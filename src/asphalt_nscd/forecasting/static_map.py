"""The static modulus of a network of two phases as a function of the modulus of one: a Stieltjes function.

F(x) = a + b x + sum of w x / (1 + x / s), with a, b, w >= 0 (Bergman 1978, Milton 1981): a few static solutions with
real x fix it, and it then holds for the complex moduli of all temperatures and frequencies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

RATIOS = np.geomspace(3e-7, 1.0, 12)
"""Modulus of the matrix over that of the grains, at which a network is solved."""
POLES = np.geomspace(1e-8, 10.0, 73)  # eight a decade, beyond the ratios on both sides


@dataclass(frozen=True)
class StaticMap:
    """F(x) = a + b x + sum of w x / (1 + x / s) of a level, moduli over that of its grains.

    `constant` is a, `slope` b, `weight` (p,) w, `pole` (p,) s; `error` is the largest relative deviation from the
    solutions it was made of.
    """

    constant: float
    slope: float
    weight: np.ndarray
    pole: np.ndarray
    error: float

    def __call__(self, ratio: np.ndarray) -> np.ndarray:
        """F at real or complex ratios (...)."""
        x = np.asarray(ratio)[..., None]
        return self.constant + self.slope * x[..., 0] + (self.weight * x / (1.0 + x / self.pole)).sum(axis=-1)


def fit_map(values: np.ndarray, ratios: np.ndarray = RATIOS) -> StaticMap:
    """The map through static solutions F (n,) at `ratios` x (n,); twice as many leave a tenth of its error, or less."""
    x = ratios[:, None]
    basis = np.hstack([np.ones_like(x), x, x / (1.0 + x / POLES)]) / values[:, None]
    size = np.linalg.norm(basis, axis=0)
    # weights that are not negative keep F passive at complex moduli, at which nothing was solved
    found = nnls(basis / size, np.ones(ratios.size), maxiter=100 * size.size)[0] / size
    error = float(np.abs(basis @ found - 1.0).max())
    kept = found[2:] > 0.0
    return StaticMap(float(found[0]), float(found[1]), found[2:][kept], POLES[kept], error)
