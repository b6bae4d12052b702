"""How far measured phases lie above what |E*| of their own isotherm requires: no law, no shift, no other isotherm.

Modulus and phase of an isotherm are jointly normal (`kramers_kronig`); all its phases may be off by one constant, of
which nothing is known before. The constant is found by generalised least squares, for each ripple of the law, and the
ripples are weighed by their evidence. It says that something is there, not what: a delay shows in
it too.

How exact it is, the specimens tell. Each has an excess of its own, and mountings, which move all phases of a sweep or
tilt its |E*|, make them differ by more than single tests do, most where a mix is soft.
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
# Standard errors of the largest excess of a table from which it speaks for a mix that is not linear: of 100 drawn
# tables without one, 99 stay below; the nine NCAT states have 4 to 9.
SPEAKS = 3.0
# Before the specimens speak: ln of how far their excesses scatter, over what single tests alone make, and the growth of
# that from the coldest to the warmest isotherm; mean and standard deviation. NCAT's specimens: -2 and 0 at 4 and
# 40 degC.
WIDER, GROWTH = (0.0, 0.7), (1.0, 0.7)
NODES = np.linspace(-3.0, 3.0, 25)  # standard deviations


@dataclass(frozen=True)
class ExcessPhase:
    """Mean excess of the phases of an isotherm [degC] and its standard error, both [rad]."""

    temperature: float
    excess: float
    std_error: float


@dataclass(frozen=True)
class _Alike:
    """Specimens tested at the same frequencies: mean excess and that of `each` (s,) [rad], and variances [rad^2].

    `law`: by what the band does not show of the mix; `single`: of one specimen, by chance of its single tests.
    """

    excess: float
    law: float
    single: float
    each: Vector


def excess_phases(observed: Observations, noise: Noise) -> list[ExcessPhase]:
    """The excess of each isotherm in which some specimen was tested at three frequencies or more."""
    sweeps = {float(t): _sweeps(observed, noise, observed.isotherm == t) for t in observed.isotherms}
    sweeps = {temperature: alike for temperature, alike in sweeps.items() if alike}
    if not sweeps:
        return []
    wider = _wider(np.array([*sweeps]), [*sweeps.values()])
    return [ExcessPhase(t, *_combined(alike, w)) for (t, alike), w in zip(sweeps.items(), wider, strict=True)]


def shows_excess(observed: Observations, noise: Noise) -> bool:
    """Whether the phases of some isotherm lie above what their own |E*| requires, beyond chance, and of none warmer
    below: what a mix does where it is soft does not turn about where it is softer.
    """
    found = [one.excess / one.std_error for one in excess_phases(observed, noise)]
    return any(z > SPEAKS and min(found[k:]) > -SPEAKS for k, z in enumerate(found))


def constant_excess(frequency: Vector, mean: NDArray, variance: NDArray) -> tuple[float, float]:
    """Excess and standard error [rad] of mean ln|E*| and phase (2, k) at k frequencies [Hz].

    `variance` (2, k) of each mean.

    >>> frequency = np.array([0.1, 1.0, 10.0])
    >>> power_law = np.array([0.3 * np.log(frequency), np.full(3, 0.3 * np.pi / 2 + 0.02)])
    >>> round(constant_excess(frequency, power_law, np.full((2, 3), 1e-6))[0], 3)
    0.02
    """
    alike = _excess_of(frequency, mean[None], variance)
    return alike.excess, float(np.sqrt(alike.law + alike.single))


def _excess_of(frequency: Vector, tests: NDArray, variance: NDArray) -> _Alike:
    """Excess of s specimens from ln|E*| and phase [rad] (s, 2, k) at k frequencies [Hz]; `variance` (2, k)."""
    number, _, k = tests.shape
    # the level says nothing of the slope; centred, it costs no digits
    level = tests[:, :1].mean(axis=2, keepdims=True) * np.array([[1.0], [0.0]])
    values = (tests - level).reshape(number, -1)
    mean = values.mean(axis=0)
    phases = np.repeat([0.0, 1.0], k)
    own = np.maximum(variance.ravel() / number, ROUNDING**2)
    precision = np.linalg.inv(_covariances(tuple(frequency)) + np.diag(own))
    information = phases @ precision @ phases
    weight = phases @ precision / information[:, None]
    excess = weight @ mean
    misfit = mean @ precision @ mean - excess**2 * information
    evidence = np.log(WEIGHTS) + 0.5 * (np.linalg.slogdet(precision)[1] - misfit - np.log(information))
    share = np.exp(evidence - logsumexp(evidence))
    mean_excess = float(share @ excess)
    single = float(share @ weight**2 @ own)
    spread = float(share @ (1.0 / information + (excess - mean_excess) ** 2))
    return _Alike(mean_excess, max(spread - single, 0.0), number * single, values @ (share @ weight))


_covariances = cache(covariances)  # isotherms and specimens share their frequencies


def _sweeps(observed: Observations, noise: Noise, rows: NDArray[np.bool_]) -> list[_Alike]:
    """The excess of an isotherm, for each set of frequencies; a specimen's sweeps at several amplitudes are one."""
    alike: dict[tuple[float, ...], dict[int, list[NDArray[np.int64]]]] = {}
    sweep = blocks(observed)
    for number in np.unique(sweep[rows]):
        own = np.flatnonzero(sweep == number)
        own = own[np.argsort(observed.frequency[own])]
        frequencies = tuple(observed.frequency[own])
        if len(set(frequencies)) == len(frequencies) >= LEAST:
            alike.setdefault(frequencies, {}).setdefault(observed.specimen[own[0]], []).append(own)
    return [_of_specimens(observed, noise, *item) for item in alike.items()]


def _of_specimens(
    observed: Observations,
    noise: Noise,
    frequencies: tuple[float, ...],
    members: dict[int, list[NDArray[np.int64]]],
) -> _Alike:
    """The excess of specimens; `members` has the sweeps of each, a sweep as the rows (k,) of its tests."""
    logarithm = np.array([observed.logarithm[sweeps].mean(axis=0) for sweeps in members.values()])
    variance = [(noise.within[:, sweeps] ** 2).mean(axis=1) / len(sweeps) for sweeps in members.values()]
    tests = np.stack([logarithm.real, logarithm.imag], axis=1)
    return _excess_of(np.array(frequencies), tests, np.mean(variance, axis=0))


def _wider(temperature: Vector, isotherms: list[list[_Alike]]) -> Vector:
    """Factor (t,) on the variance of excesses by single tests, to that of specimens: by their scatter, and a prior."""
    place = (temperature - temperature.min()) / (np.ptp(temperature) or 1.0) - 0.5 * (temperature.size > 1)
    deviation = (mean + spread * NODES for mean, spread in (WIDER, GROWTH))
    size, growth = np.meshgrid(*deviation, indexing="ij")
    variance = np.exp(2.0 * (size + growth * place[:, None, None]))
    evidence = -0.5 * (NODES[:, None] ** 2 + NODES**2)
    for alike, own in zip(isotherms, variance, strict=True):
        each = np.concatenate([one.each for one in alike])
        weight = np.concatenate([np.full(one.each.size, 1.0 / one.single) for one in alike])
        squares = weight @ (each - weight @ each / weight.sum()) ** 2
        evidence -= 0.5 * ((each.size - 1) * np.log(own) + squares / own)
    return np.tensordot(variance, np.exp(evidence - logsumexp(evidence)))


def _combined(alike: list[_Alike], wider: float) -> tuple[float, float]:
    """Mean excess and standard error [rad]; what lies outside the band is one unknown, however many the specimens."""
    excess, law, single = np.array([(one.excess, one.law, one.single / one.each.size) for one in alike]).T
    weight = 1.0 / (law + wider * single)
    share = weight / weight.sum()
    variance = (share @ np.sqrt(law)) ** 2 + share**2 @ (wider * single)
    return float(share @ excess), float(np.sqrt(variance))
