"""Units of moduli, by what one of each is in MPa, and of temperatures."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:  # the help of the command line reads this table, and must not wait for numpy
    import numpy as np

Degrees = TypeVar("Degrees", float, "np.ndarray")

PSI = 6894.757293168  # Pa
MEGAPASCAL = {
    "Pa": 1e-6,
    "kPa": 1e-3,
    "MPa": 1.0,
    "GPa": 1e3,
    "N/mm2": 1.0,
    "MN/m2": 1.0,
    "kgf/cm2": 0.0980665,
    "psi": 1e-6 * PSI,
    "ksi": 1e-3 * PSI,
}


def celsius_of_fahrenheit(degrees: Degrees) -> Degrees:
    """Temperature in degC of one in degF.

    >>> celsius_of_fahrenheit(14.0)
    -10.0
    """
    return (degrees - 32.0) / 1.8
