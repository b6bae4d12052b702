"""What others would forecast from the same recipe: mean fields and regressions. Equations as published.

One that is drawn has a title in `TITLES` of `reporting/figures/forecast_panels.py`, and a dash in `DASHES` of `style`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from asphalt_nscd.forecasting.levels import Level, levels_of
from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.measurements.units import PSI

BINDER_BULK = 2.5e9  # Pa
ROUNDS = 2000  # of the self-consistent iteration


def mori_tanaka(recipe: Recipe) -> np.ndarray:
    """E* (n,) [Pa]: stiff spheres in each level's matrix, then air voids in the mix (Mori & Tanaka 1973)."""
    return _levels(recipe, _dilute_in_matrix)


def self_consistent(recipe: Recipe) -> np.ndarray:
    """E* (n,) [Pa]: grains of each level and its matrix as spheres in the level itself (Hill 1965)."""
    return _levels(recipe, _self_consistent_moduli)


def hirsch(recipe: Recipe) -> np.ndarray:
    """E* (n,) [Pa] of the regression of Christensen, Pellinen & Bonaquist (2003), with their equation of the phase."""
    shear = np.abs(recipe.binder_modulus()) / 3.0 / PSI
    vma, vfa = _volumetrics(recipe)
    filled = vfa * 3.0 * shear / vma
    # In psi: 4.2e6 is the modulus that the regression gives all aggregates.
    contact = (20.0 + filled) ** 0.58 / (650.0 + filled**0.58)
    parallel = 4.2e6 * (1.0 - vma / 100.0) + 3.0 * shear * vfa * vma / 1e4
    series = (1.0 - vma / 100.0) / 4.2e6 + vma / (3.0 * vfa * shear)
    modulus = contact * parallel + (1.0 - contact) / series
    phase = -21.0 * np.log10(contact) ** 2 - 55.0 * np.log10(contact)
    return PSI * modulus * np.exp(1j * np.radians(phase))


def witczak(recipe: Recipe) -> np.ndarray:
    """|E*| (n,) [Pa] of the regression of Bari & Witczak (2006), which gives no phase, so the result has none."""
    binder = recipe.binder_modulus()
    shear, phase = np.abs(binder) / 3.0 / PSI, np.degrees(np.angle(binder))
    passing = recipe.grading.passing_at
    p200 = 100.0 * float(passing(0.075e-3))
    r4, r38, r34 = (100.0 * (1.0 - float(passing(size))) for size in (4.75e-3, 9.5e-3, 19e-3))
    air = 100.0 * recipe.voids
    vma, vfa = _volumetrics(recipe)
    binder_share = vfa / 100.0  # Vbeff / (Va + Vbeff)
    first = (
        6.65 - 0.032 * p200 + 0.0027 * p200**2 + 0.011 * r4 - 0.0001 * r4**2
        + 0.006 * r38 - 0.00014 * r38**2 - 0.08 * air - 1.06 * binder_share
    )  # fmt: skip
    second = 2.56 + 0.03 * air + 0.71 * binder_share + 0.012 * r38 - 0.0001 * r38**2 - 0.01 * r34
    sigmoid = 1.0 + np.exp(-0.7814 - 0.5785 * np.log10(shear) + 0.8834 * np.log10(phase))
    return PSI * 10.0 ** (-0.349 + 0.754 * shear**-0.0052 * first + second / sigmoid) + 0j


RIVALS: dict[str, Callable[[Recipe], np.ndarray]] = {
    "mori_tanaka": mori_tanaka,
    "self_consistent": self_consistent,
    "hirsch": hirsch,
    "witczak": witczak,
}


def _volumetrics(recipe: Recipe) -> tuple[float, float]:
    """Voids in the mineral aggregate, and their share filled with binder [%]."""
    binder = (1.0 - recipe.aggregate_fraction) * (1.0 - recipe.voids)
    vma = binder + recipe.voids
    return 100.0 * vma, 100.0 * binder / vma


def _levels(recipe: Recipe, mix: Callable[..., tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """E* [Pa] after all levels and the air voids; bulk and shear moduli carried along."""
    young = recipe.binder_modulus()
    bulk = np.full(young.shape, BINDER_BULK, complex)
    shear = 3.0 * bulk * young / (9.0 * bulk - young)
    stone = recipe.aggregate
    level: Level
    for level in levels_of(recipe):
        bulk, shear = mix(bulk, shear, stone.bulk, stone.shear, level.fraction)
    bulk, shear = mix(bulk, shear, 0.0, 0.0, recipe.voids)
    return 9.0 * bulk * shear / (3.0 * bulk + shear)


def _dilute_in_matrix(
    bulk: np.ndarray, shear: np.ndarray, other_bulk: float, other_shear: float, fraction: float
) -> tuple[np.ndarray, np.ndarray]:
    """Spheres in a matrix; for stiff ones the lower bound of Hashin & Shtrikman (1963)."""
    alpha, beta = _sphere(bulk, shear)
    mixed_bulk = bulk + fraction * (other_bulk - bulk) / (
        1.0 + (1.0 - fraction) * alpha * (other_bulk / bulk - 1.0)
    )
    mixed_shear = shear + fraction * (other_shear - shear) / (
        1.0 + (1.0 - fraction) * beta * (other_shear / shear - 1.0)
    )
    return mixed_bulk, mixed_shear


def _self_consistent_moduli(
    bulk: np.ndarray, shear: np.ndarray, other_bulk: float, other_shear: float, fraction: float
) -> tuple[np.ndarray, np.ndarray]:
    """Spheres of both phases in the mixture that they make, by iteration from the matrix."""
    mixed_bulk, mixed_shear = _dilute_in_matrix(bulk, shear, other_bulk, other_shear, fraction)
    ones = np.ones_like(bulk)
    phases = (1.0 - fraction, bulk, shear), (fraction, other_bulk * ones, other_shear * ones)
    for _ in range(ROUNDS):
        alpha, beta = _sphere(mixed_bulk, mixed_shear)
        seen = [
            (
                share / (1.0 + alpha * (k / mixed_bulk - 1.0)),
                k,
                share / (1.0 + beta * (g / mixed_shear - 1.0)),
                g,
            )
            for share, k, g in phases
        ]
        volume, bulks, distortion, shears = (np.array(column) for column in zip(*seen, strict=True))
        mixed_bulk = (volume * bulks).sum(axis=0) / volume.sum(axis=0)
        mixed_shear = (distortion * shears).sum(axis=0) / distortion.sum(axis=0)
    return mixed_bulk, mixed_shear


def _sphere(bulk: np.ndarray, shear: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eshelby's alpha and beta of a sphere in a medium."""
    alpha = 3.0 * bulk / (3.0 * bulk + 4.0 * shear)
    beta = 6.0 * (bulk + 2.0 * shear) / (5.0 * (3.0 * bulk + 4.0 * shear))
    return alpha, beta
