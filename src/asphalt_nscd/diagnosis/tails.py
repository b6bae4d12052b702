"""Probabilities of tails, straight from scipy.special: scipy.stats, which calls the same, takes a second to import."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special


def normal(z: ArrayLike) -> Any:
    """P(Z > z) of a standard normal variable."""
    return special.ndtr(np.negative(z))


def normal_beyond(probability: ArrayLike) -> Any:
    """z with P(Z > z) = probability."""
    return -special.ndtri(probability)


def chi_squared(square: ArrayLike, freedom: ArrayLike) -> Any:
    """P(X > square) of chi-squared."""
    return special.chdtrc(freedom, square)


def fisher(ratio: ArrayLike, above: ArrayLike, below: ArrayLike) -> Any:
    """P(F > ratio) of Fisher's F with degrees of freedom above and below."""
    return special.fdtrc(above, below, ratio)


def student(t: ArrayLike, freedom: ArrayLike) -> Any:
    """P(T > t) of Student's t."""
    return special.stdtr(freedom, np.negative(t))
