"""Replicate scatter (pure error): what repetitions of one condition on other specimens differ by."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, fdtrc

from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations, Vector

STATED = 10**6  # degrees of freedom of a scatter that is known
SPECIMEN_SCALE = 0.03  # standard deviation of ln|E*| between specimens of one mix, worth SCALE_FREEDOM
SPECIMEN_PHASE = float(np.radians(0.3))  # the same of the phase, two mountings of 0.2 deg
FLOOR = 5e-4  # of ln|E*| and of the phase [rad]: no two tests repeat better
UNEVEN = 1e-3  # chance below which isotherms are given a scatter each
SCALE_FREEDOM = 8  # degrees of freedom against those of the table


def pure_error(observed: Observations, nuisance: NDArray) -> tuple[Vector, Vector, int]:
    """Residuals (n,) of ln|E*| and of the phase [rad] within conditions, and their degrees of freedom.

    `nuisance` (n, k), what specimens may differ by other than scatter (scales, clamps, ...), is projected out, so that
    a cause confined to a specimen does not pass for scatter. The degrees of freedom are zero where nothing was
    repeated.
    """
    cells = np.eye(observed.cell.max() + 1)[observed.cell]
    logarithm = observed.logarithm
    zero = np.zeros_like(cells)
    design = np.vstack([np.hstack([cells, zero, nuisance.real]), np.hstack([zero, cells, nuisance.imag])])
    values = np.concatenate([logarithm.real, logarithm.imag])
    residual, freedom = unexplained(design, values)
    modulus, phase = np.split(residual, 2)
    return modulus, phase, freedom


def unexplained(design: NDArray, values: NDArray) -> tuple[NDArray, int]:
    """Residuals (n, ...) that a design (n, k) leaves, and their degrees of freedom; columns alike count once."""
    left, size, _ = np.linalg.svd(design, full_matrices=False)
    left = left[:, size > 1e-9 * size[0]]
    return values - left @ (left.T @ values), values.shape[0] - left.shape[1]


def estimate(observed: Observations, nuisance: NDArray, scales: Vector) -> Noise | None:
    """Noise of a table; None where no condition was repeated.

    A scatter that a whole isotherm of a specimen shares (its temperature, its mounting) is a component of its own.
    `nuisance`: what replicates may differ by beside scatter; `scales` (S,): ln of the specimens' scales, first guess.
    """
    modulus, phase, freedom = pure_error(observed, nuisance)
    # of five degrees of freedom the 95 % interval of a scatter spans a factor of four
    if freedom < 6:
        return None
    # each residual is smaller than the scatter by what the conditions took; the same factor for all
    share = 2.0 * observed.size / freedom
    block = _blocks(observed)
    within, shared, sigmas = [], [], []
    for residual in (modulus, phase):
        size = _isotherm_scatter(residual, observed.isotherm, share)
        single, common = _components(residual / size, block, share)
        single = max(single, FLOOR**2)
        within.append(np.sqrt(single) * size)
        shared.append(np.sqrt(common) * size)
        sigmas.append(float(np.sqrt(single + common)))
    return Noise(np.array(within), np.array(shared), block, (sigmas[0], sigmas[1]), _scale(scales), freedom)


def stated(
    observed: Observations, modulus: float, phase: float, scale: float, freedom: int = STATED
) -> Noise:
    """Noise of stated size for each test: relative scatter of |E*|, of the phase [rad], scale of whole specimens."""
    within = np.tile([[modulus], [phase]], observed.size)
    return Noise(within, np.zeros_like(within), _blocks(observed), (modulus, phase), scale, freedom)


def _blocks(observed: Observations) -> NDArray[np.int64]:
    pairs = np.column_stack([observed.specimen, observed.isotherm])
    return np.unique(pairs, axis=0, return_inverse=True)[1].ravel()


def _isotherm_scatter(residual: Vector, temperature: Vector, share: float) -> Vector:
    """Scatter (n,) of each isotherm over the mean one; ones where they differ by no more than chance."""
    isotherms, label, count = np.unique(temperature, return_inverse=True, return_counts=True)
    variance = np.bincount(label, residual**2) / count
    freedom = count / share
    mean = float(freedom @ variance / freedom.sum())
    if isotherms.size < 2 or freedom.min() < 4.0 or mean <= 0.0 or variance.min() <= 0.0:
        return np.ones(residual.size)
    # Bartlett's test
    statistic = freedom.sum() * np.log(mean) - freedom @ np.log(variance)
    statistic /= 1.0 + ((1.0 / freedom).sum() - 1.0 / freedom.sum()) / (3.0 * (isotherms.size - 1))
    if chdtrc(isotherms.size - 1, max(statistic, 0.0)) > UNEVEN:
        return np.ones(residual.size)
    return np.sqrt(variance / mean)[label]


def _components(residual: Vector, block: NDArray, share: float) -> tuple[float, float]:
    """Variances of single tests and of whole blocks (analysis of variance), given the lost freedom."""
    count = np.bincount(block)
    mean = np.bincount(block, residual) / count
    inner = residual - mean[block]
    rows, blocks = residual.size, count.size
    total = max(float(residual @ residual) / rows * share, 1e-12)
    if rows <= blocks + 2:
        return total, 0.0
    within = float(inner @ inner) / (rows - blocks) * share
    size = rows / blocks
    between = float((count * mean) @ mean) / blocks * share
    shared = max((between - within) / size, 0.0)
    # An excess that chance makes is no component: F of blocks against tests.
    if shared == 0.0 or fdtrc(blocks / share, (rows - blocks) / share, between / within) > 0.01:
        return total, 0.0
    return within, shared


def _scale(scales: Vector) -> float:
    known = SCALE_FREEDOM * SPECIMEN_SCALE**2
    spread = np.abs(scales - np.median(scales))
    # By the median: one wrong diameter must not widen what all specimens may differ by.
    robust = 1.4826 * float(np.median(spread)) if scales.size > 2 else 0.0
    freedom = max(scales.size - 1, 0)
    return float(np.sqrt((known + freedom * robust**2) / (SCALE_FREEDOM + freedom)))


def median_by(values: Vector, label: NDArray[np.int64]) -> Vector:
    """Median of the group of each row (n,); `label` (n,) is the group."""
    medians = np.array([np.median(values[label == k]) for k in range(label.max() + 1)])
    return medians[label]
