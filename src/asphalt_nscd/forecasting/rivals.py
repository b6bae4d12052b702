"""What others would forecast from the same recipe: two regressions as published, and a mean field.

One that is drawn has a title in `TITLES` of `reporting/figures/forecast_panels.py`, and a dash in `DASHES` of `style`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.forecasting.scheme import Settings, modulus_of_mix
from asphalt_nscd.measurements.units import PSI
from asphalt_nscd.rheology.hirsch import contact_share, hirsch_modulus


def hirsch(recipe: Recipe) -> np.ndarray:
    """E* (n,) [Pa] of the regression of Christensen, Pellinen & Bonaquist (2003), with their equation of the phase."""
    shear, (vma, vfa) = np.abs(recipe.binder_modulus()) / 3.0, volumetrics(recipe)
    contact = contact_share(shear, vma, vfa)
    phase = -21.0 * np.log10(contact) ** 2 - 55.0 * np.log10(contact)
    return hirsch_modulus(shear, vma, vfa) * np.exp(1j * np.radians(phase))


def witczak(recipe: Recipe) -> np.ndarray:
    """|E*| (n,) [Pa] of the regression of Bari & Witczak (2006), which gives no phase, so the result has none."""
    binder = recipe.binder_modulus()
    shear, phase = np.abs(binder) / 3.0 / PSI, np.degrees(np.angle(binder))
    passing = recipe.grading.passing_at
    p200 = 100.0 * float(passing(0.075e-3))
    r4, r38, r34 = (100.0 * (1.0 - float(passing(size))) for size in (4.75e-3, 9.5e-3, 19e-3))
    air = 100.0 * recipe.voids
    vma, vfa = volumetrics(recipe)
    binder_share = vfa / 100.0  # Vbeff / (Va + Vbeff)
    first = (
        6.65 - 0.032 * p200 + 0.0027 * p200**2 + 0.011 * r4 - 0.0001 * r4**2
        + 0.006 * r38 - 0.00014 * r38**2 - 0.08 * air - 1.06 * binder_share
    )  # fmt: skip
    second = 2.56 + 0.03 * air + 0.71 * binder_share + 0.012 * r38 - 0.0001 * r38**2 - 0.01 * r34
    sigmoid = 1.0 + np.exp(-0.7814 - 0.5785 * np.log10(shear) + 0.8834 * np.log10(phase))
    return PSI * 10.0 ** (-0.349 + 0.754 * shear**-0.0052 * first + second / sigmoid) + 0j


def differential(recipe: Recipe) -> np.ndarray:
    """E* (n,) [Pa] of the differential scheme alone: the forecast without contacts."""
    return modulus_of_mix(recipe, recipe.binder_modulus(), Settings(contacts=0.0, pressure=0.0))


RIVALS: dict[str, Callable[[Recipe], np.ndarray]] = {
    "hirsch": hirsch,
    "witczak": witczak,
    "differential": differential,
}


def volumetrics(recipe: Recipe) -> tuple[float, float]:
    """Voids in the mineral aggregate, and their share filled with binder [%]."""
    binder = (1.0 - recipe.aggregate_fraction) * (1.0 - recipe.voids)
    vma = binder + recipe.voids
    return 100.0 * vma, 100.0 * binder / vma
