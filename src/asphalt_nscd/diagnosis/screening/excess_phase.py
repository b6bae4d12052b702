"""How far measured phases lie above what |E*| of their own isotherm requires: no law, no shift, no other isotherm.

Modulus and phase of an isotherm are jointly normal (`kramers_kronig`); all its phases may be off by one constant, of
which nothing is known before. The constant is found by generalised least squares, for each ripple of the law, and the
ripples are weighed by their evidence. It says that something is there, not what: a delay shows in
it too.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening.kramers_kronig import ROUNDING, WEIGHTS, covariances
from asphalt_nscd.diagnosis.screening.within_isotherm import blocks

Vector = NDArray[np.float64]
LEAST = 3  # frequencies; two tell a slope, but not whether it bends
# Standard errors of the largest excess of a table from which it speaks for a mix that is not linear: of 40 drawn tables
# without one, 39 stay below; the nine NCAT states have 3.7 to 12.
SPEAKS = 3.0


@dataclass(frozen=True)
class ExcessPhase:
    """Mean excess of the phases of an isotherm [degC] and its standard error, both [rad]."""

    temperature: float
    excess: float
    std_error: float


def excess_phases(observed: Observations, noise: Noise) -> list[ExcessPhase]:
    """The excess of each isotherm in which some specimen was tested at three frequencies or more."""
    return [
        ExcessPhase(float(temperature), *_combined(parts))
        for temperature in observed.isotherms
        if (parts := _sweeps(observed, noise, observed.isotherm == temperature))
    ]


def shows_excess(observed: Observations, noise: Noise) -> bool:
    """Whether the phases of some isotherm lie above what their own |E*| requires, beyond chance, and of none warmer
    below: what a mix does where it is soft does not turn about where it is softer.
    """
    found = [one.excess / one.std_error for one in excess_phases(observed, noise)]
    return any(z > SPEAKS and min(found[k:]) > -SPEAKS for k, z in enumerate(found))


def constant_excess(
    frequency: Vector, mean: NDArray, variance: NDArray, shared: float
) -> tuple[float, float]:
    """Excess and standard error [rad] of mean ln|E*| and phase (2, k) at k frequencies [Hz].

    `variance` (2, k) of each mean; `shared` [rad^2] is what all phases have in common by chance.

    >>> frequency = np.array([0.1, 1.0, 10.0])
    >>> power_law = np.array([0.3 * np.log(frequency), np.full(3, 0.3 * np.pi / 2 + 0.02)])
    >>> round(constant_excess(frequency, power_law, np.full((2, 3), 1e-6), 0.0)[0], 3)
    0.02
    """
    k = frequency.size
    # the level says nothing of the slope; centred, it costs no digits
    values = np.concatenate([mean[0] - mean[0].mean(), mean[1]])
    phases = np.repeat([0.0, 1.0], k)
    own = np.diag(np.maximum(variance.ravel(), ROUNDING**2))
    precision = np.linalg.inv(_covariances(tuple(frequency)) + own)
    information = phases @ precision @ phases
    excess = phases @ precision @ values / information
    misfit = values @ precision @ values - excess**2 * information
    evidence = np.log(WEIGHTS) + 0.5 * (np.linalg.slogdet(precision)[1] - misfit - np.log(information))
    share = np.exp(evidence - logsumexp(evidence))
    mean_excess = float(share @ excess)
    spread = share @ (1.0 / information + (excess - mean_excess) ** 2)
    return mean_excess, float(np.sqrt(spread + shared))


_covariances = cache(covariances)  # isotherms and specimens share their frequencies


def _sweeps(observed: Observations, noise: Noise, rows: NDArray[np.bool_]) -> list[tuple[float, float, int]]:
    """Excess, standard error [rad] and number of the specimens that were tested at the same frequencies."""
    alike: dict[tuple[float, ...], list[NDArray[np.int64]]] = {}
    sweep = blocks(observed)
    for number in np.unique(sweep[rows]):
        own = np.flatnonzero(sweep == number)
        own = own[np.argsort(observed.frequency[own])]
        frequencies = tuple(observed.frequency[own])
        if len(set(frequencies)) == len(frequencies) >= LEAST:
            alike.setdefault(frequencies, []).append(own)
    parts = []
    for frequencies, members in alike.items():
        tests, number = np.array(members), len(members)
        logarithm = observed.logarithm[tests].mean(axis=0)
        variance = (noise.within[:, tests] ** 2).mean(axis=1) / number
        shared = float((noise.shared[1, tests] ** 2).mean()) / number
        mean = np.array([logarithm.real, logarithm.imag])
        parts.append((*constant_excess(np.array(frequencies), mean, variance, shared), number))
    return parts


def _combined(parts: list[tuple[float, float, int]]) -> tuple[float, float]:
    """Mean and standard error, which does not fall with their number: what lies outside the band is one unknown."""
    excess, std_error, number = np.array(parts).T
    weight = number / std_error**2
    share = weight / weight.sum()
    return float(share @ excess), float(share @ std_error)
