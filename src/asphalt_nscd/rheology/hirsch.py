"""|E*| of a mix from |G*| of its binder and its volumetrics (Christensen, Pellinen & Bonaquist 2003)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.measurements.units import PSI

STONE = 4.2e6  # psi, the modulus that the regression gives all aggregates
GLASSY_BINDER = 1e9  # Pa, |G*| of any binder at its stiffest, as AASHTO R 84 has it


def contact_share(shear: ArrayLike, vma: float, vfa: float) -> NDArray[np.float64]:
    """Share of the aggregate in parallel with the binder; `shear` [Pa] is |G*|, `vma` and `vfa` are in percent."""
    filled = vfa * 3.0 * np.asarray(shear, float) / PSI / vma
    return np.asarray((20.0 + filled) ** 0.58 / (650.0 + filled**0.58))


def hirsch_modulus(shear: ArrayLike, vma: float, vfa: float) -> NDArray[np.float64]:
    """|E*| [Pa] of the mix; arguments as of `contact_share`."""
    binder = 3.0 * np.asarray(shear, float) / PSI
    contact = contact_share(shear, vma, vfa)
    parallel = STONE * (1.0 - vma / 100.0) + binder * vfa * vma / 1e4
    series = (1.0 - vma / 100.0) / STONE + vma / (vfa * binder)
    return np.asarray(PSI * (contact * parallel + (1.0 - contact) / series))


def limiting_modulus(vma: float, vfa: float) -> float:
    """The limiting maximum modulus [Pa] of AASHTO R 84.

    >>> f"{limiting_modulus(17.9, 61.5) / 1e9:.1f} GPa"
    '21.8 GPa'
    """
    return float(hirsch_modulus(GLASSY_BINDER, vma, vfa))
