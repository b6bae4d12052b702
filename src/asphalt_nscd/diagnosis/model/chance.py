"""What chance alone would give: score tests of directions against a fit, and the maximum over many.

With the law, the scales and the causes found so far fitted, a further effect of amplitude a moves the
whitened data along a direction d. Its gain in the objective is z^2, z = d.r / sqrt(d.A d), where
A = 1 - J P^-1 J^T takes out whatever the fitted model can follow (priors included). Under the fit all
z are jointly normal with known correlations, so the maximum over the catalogue is drawn at once:
a parametric bootstrap of the linearised model, studentised as the scatter itself is estimated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from asphalt_nscd.diagnosis.causes._cause import Cause
from asphalt_nscd.diagnosis.criteria import ABSORBED
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import specimen_named

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Structure:
    """A nameless pattern (n,) of ln E*: what an effect outside the catalogue might look like."""

    name: str
    direction: NDArray[np.complex128]


@dataclass(frozen=True)
class Scores:
    """Score tests of k directions.

    `z` (k,) of each; `information` (k,) is d.A d; `seen` (k,) says whether the law leaves enough of a direction;
    `correlation` (k, k) of the z where nothing is hidden.
    """

    z: Vector
    information: Vector
    seen: NDArray[np.bool_]
    correlation: NDArray


def scores(
    joint: Joint, fitted: Fitted, directions: NDArray[np.complex128], confined: NDArray[np.bool_]
) -> Scores:
    """Score tests of directions (n, k) of ln E*; no law takes those `confined` (k,) to a specimen."""
    d = joint.noise.whiten(directions)
    taken = fitted.jacobian.T @ d
    gram = d.T @ d - taken.T @ np.linalg.solve(fitted.precision, taken)
    information = np.diag(gram)
    # No law of the mix follows what one specimen does: only rounding is to be kept off.
    least = np.where(confined, 1e-9, ABSORBED)
    seen = information > least * np.maximum((d**2).sum(axis=0), 1e-300)
    norm = np.sqrt(np.where(seen, information, 1.0))
    # One Newton step to the very best: a fit ends within a tolerance of it.
    to_best = np.linalg.solve(fitted.precision, fitted.gradient)
    z = np.where(seen, d.T @ (fitted.residual - fitted.jacobian @ to_best) / norm, 0.0)
    correlation = gram / norm[:, None] / norm * (seen[:, None] & seen)
    return Scores(z, information, seen, 0.5 * (correlation + correlation.T))


def largest_by_chance(
    correlation: NDArray, one_sided: NDArray[np.bool_], freedom: int, draws: int, random: np.random.Generator
) -> Vector:
    """Largest of k z of a correlation (k, k) in each of `draws` (draws,), absolute or upwards only, by chance alone.

    `freedom` is that of the scatter.
    """
    value, vector = np.linalg.eigh(correlation)
    # By eigenvalues, since causes that look alike leave the correlation without a Cholesky factor. The symmetric root:
    # signs of eigenvectors are rounding, and with them the draws of a seed would differ between processors.
    root = (vector * np.sqrt(np.maximum(value, 0.0))) @ vector.T
    normal = random.standard_normal((draws, value.size)) @ root
    normal = np.where(one_sided, normal, np.abs(normal))
    student = np.sqrt(freedom / random.chisquare(freedom, draws))
    return np.maximum(normal.max(axis=1, initial=0.0), 0.0) * student


def tail(by_chance: Vector, z: float) -> float:
    """Chance of z or more, above zero: the share of draws, or where few are left the normal tail that meets them."""
    count = np.count_nonzero(by_chance >= z)
    # Fewer than ten draws tell a chance to a third at best.
    if count >= 10:
        return count / by_chance.size
    most = max(0.01, 10 / by_chance.size)
    edge = float(np.quantile(by_chance, 1.0 - most))
    return float(min(most, most * float(ndtr(-z)) / float(ndtr(-edge))))


def catalogue_candidates(observed: Observations, catalogue: Sequence[Cause]) -> list[Candidate]:
    """Every cause at every place with every starting shape, absent (amplitude zero)."""
    return [
        Candidate(variant, place, (0.0, *shape))
        for cause in catalogue
        for place in cause.places(observed)
        for variant in cause.variants()
        for shape in cause.shapes(observed)
    ]


def candidate_directions(joint: Joint, fitted: Fitted, candidates: list[Candidate]) -> NDArray:
    """Derivatives (n, k) of ln E* with respect to the amplitudes, in typical units."""
    active = fitted.active
    return (
        np.column_stack(
            [joint.direction(fitted.law, fitted.scales, (*active, c), len(active), 0) for c in candidates]
        )
        if candidates
        else np.zeros((joint.observed.size, 0), complex)
    )


def structures(observed: Observations) -> list[Structure]:
    """Nameless patterns of modulus and of phase by frequency, isotherm, specimen, condition and single test."""
    # Centred, so that slopes and bends hold nothing of the level.
    log_f = np.log(observed.frequency) - np.log(observed.frequency).mean()
    above = observed.temperature - observed.temperature.mean()
    patterns = {
        "slope over frequency": log_f,
        "slope over temperature": above,
        "bend over frequency": log_f**2,
        "bend over temperature": above**2,
        "slope over frequency growing with temperature": log_f * above,
        "slope over frequency in warm tests": log_f * np.maximum(above, 0.0),
        "warm tests": np.maximum(above, 0.0),
    }
    for f in observed.frequencies:
        patterns[f"{f:g} Hz"] = observed.frequency == f
        patterns[f"above {f:g} Hz"] = observed.frequency > f
    for t in observed.isotherms:
        patterns[f"{t:g} degC"] = observed.isotherm == t
        patterns[f"{t:g} degC, slope over frequency"] = (observed.isotherm == t) * log_f
    for cell in range(observed.cell.max() + 1):
        at = observed.cell == cell
        row = int(np.flatnonzero(at)[0])
        patterns[f"{observed.isotherm[row]:g} degC, {observed.frequency[row]:g} Hz"] = at
    return _both(patterns) + structures_of_replicates(observed)


def structures_of_replicates(observed: Observations) -> list[Structure]:
    """Nameless patterns by which tests of one condition may differ: one specimen, the course of the tests."""
    patterns = {}
    course = observed.order if observed.cycles is None else observed.cycles
    if course is not None:
        patterns["course of the tests"] = course - course.mean()
    if len(observed.names) > 1:
        log_f = np.log(observed.frequency) - np.log(observed.frequency).mean()
        above = observed.temperature - observed.temperature.mean()
        for k, name in enumerate(observed.names):
            at = observed.specimen == k
            patterns[specimen_named(name)] = at
            patterns[f"{specimen_named(name)}, slope over frequency"] = at * log_f
            patterns[f"{specimen_named(name)}, slope over temperature"] = at * above
    return _both(patterns)


def _both(patterns: dict[str, NDArray]) -> list[Structure]:
    """Each pattern in the modulus and in the phase."""
    return [
        Structure(f"{name}, {part}", np.asarray(unit * pattern, complex))
        for name, pattern in patterns.items()
        if np.any(pattern)
        for part, unit in (("modulus", 1.0), ("phase", 1j))
    ]
