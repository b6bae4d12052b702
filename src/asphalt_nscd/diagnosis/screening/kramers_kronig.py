"""The phase that |E*| requires: Kramers-Kronig in the form of Bode, with what lies outside the band as a prior.

A linear material that only answers after it is loaded, and whose E* has no zero in the right half plane (every
spectrum of relaxation times with positive strengths), obeys Bode (1945), with u = ln omega:

    phase(u) = 1/pi integral of s(v) ln coth(|v - u| / 2) dv,    s = d ln|E*| / d ln omega.

The relation is exact and linear in the slope s. Modulus and phase are therefore jointly normal where s is: here a
constant, a slow and a quick Gaussian process over u. Four sizes of the quick one are tried, from a smooth spectrum
(0.01) to a single relaxation time (0.3); the data weigh them. What the band does not show enters the standard error.

Error of the phase found from |E*| of 5 and 6 frequencies (0.1 to 25 Hz), ten decades of reduced frequency (cold to
hot), rms in degrees; in brackets the share of errors beyond three of the stated standard errors:

    law                cubic in ln f, first order   spectrum of Maxwell elements   this relation
    2S2P1D (5 mixes)            2.2                        1.0 (3 %)                 0.9 (0 %)
    Huet-Sayegh (2)             1.2                        0.8 (0 %)                 0.5 (0 %)
    Havriliak-Negami (2)        0.6                        0.5 (0 %)                 0.4 (0 %)
    Burgers (2)                 7.2                        3.1 (40 %)                4.0 (9 %)
    Zener (2)                   7.6                        2.8 (40 %)                3.6 (10 %)

Maxwell elements (one each e-fold, logarithms of their strengths smoothed) need an iteration and are surer than they
may be where a law has one relaxation time only. Inside the band the error is a fifth of that at its ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import logsumexp, spence

Vector = NDArray[np.float64]
CELL = 0.2  # of ln f: step of the slope, against its shortest length of 1.5
MARGIN = 14.0  # of ln f beyond the band; the kernel there is below 1e-6
LEVEL = 10.0  # standard deviation of ln|E*|: none is preferred
CONSTANT = 0.4  # standard deviations of the slope: its mean,
SLOW = 0.2, 4.0  # its slow part and the length of that in ln f,
QUICK = 1.5  # the length of its quick part,
RIPPLES = (0.01, 0.03, 0.1, 0.3)  # and the sizes of that,
WEIGHTS = (0.70, 0.18, 0.08, 0.04)  # with the weights they have before the data speak
ROUNDING = 1e-3  # of ln|E*|: no table is more exact


@dataclass(frozen=True)
class Required:
    """Phase (n,) that |E*| requires, and its standard error (n,), both [rad]."""

    phase: Vector
    std_error: Vector


def required_phase(frequency: ArrayLike, log_modulus: ArrayLike, scatter: ArrayLike = ROUNDING) -> Required:
    """Phase [rad] and its standard error (n,) that ln|E*| of one isotherm of one specimen requires.

    Bode's relation, see the module. `frequency` (n,) in Hz; `scatter`: standard deviation of ln|E*| of one test, or of
    each (n,).

    >>> power_law = required_phase([0.1, 1.0, 10.0], [0.0, 0.3 * np.log(10.0), 0.3 * np.log(100.0)])
    >>> float(np.degrees(power_law.phase[1]).round())  # 0.3 * 90 degrees
    27.0
    """
    log_modulus = np.asarray(log_modulus, float)
    n = log_modulus.size
    # the level says nothing of the slope; centred, it costs no digits against LEVEL
    centred = log_modulus - log_modulus.mean()
    evidence, means, variances = [], [], []
    for covariance, weight in zip(covariances(frequency), WEIGHTS, strict=True):
        own = covariance[:n, :n] + np.maximum(scatter, ROUNDING) ** 2 * np.eye(n)
        gain = np.linalg.solve(own, covariance[:n, n:])
        evidence.append(
            np.log(weight) - 0.5 * (centred @ np.linalg.solve(own, centred) + np.linalg.slogdet(own)[1])
        )
        means.append(gain.T @ centred)
        variances.append(np.diag(covariance[n:, n:] - covariance[n:, :n] @ gain))
    # the ripple is averaged over, not chosen: five frequencies seldom tell a smooth spectrum from one
    # relaxation time
    share = np.exp(np.array(evidence) - logsumexp(evidence))
    mean = share @ np.array(means)
    spread = share @ (np.maximum(variances, 0.0) + (np.array(means) - mean) ** 2)
    return Required(mean, np.sqrt(spread))


def covariances(frequency: ArrayLike) -> NDArray:
    """Prior covariance (4, 2n, 2n) of ln|E*| and phase [rad] at n frequencies [Hz], for each of RIPPLES."""
    log_f = np.log(np.asarray(frequency, float))
    edges = np.arange(log_f.min() - MARGIN, log_f.max() + MARGIN + CELL, CELL)
    modulus = _integral(edges, log_f) - _integral(edges, np.array([log_f.mean()]))
    # Bode's kernel is integrated in closed form over each cell: it has a logarithmic pole in one of them.
    phase = np.diff(_primitive(edges - log_f[:, None]), axis=1) / np.pi
    of_slope = np.vstack([modulus, phase])
    centre = 0.5 * (edges[1:] + edges[:-1])
    apart = centre[:, None] - centre
    slow = CONSTANT**2 + SLOW[0] ** 2 * np.exp(-0.5 * (apart / SLOW[1]) ** 2)
    quick = np.exp(-0.5 * (apart / QUICK) ** 2)
    slow, quick = (of_slope @ kernel @ of_slope.T for kernel in (slow, quick))
    # a wide prior of the level stands for a flat one and keeps the covariance regular
    slow[: log_f.size, : log_f.size] += LEVEL**2
    return slow + np.array(RIPPLES)[:, None, None] ** 2 * quick


def _integral(edges: Vector, until: Vector) -> NDArray:
    """Length (n, cells) of each cell that lies below each of the places."""
    return np.clip(until[:, None] - edges[:-1], 0.0, np.diff(edges))


def _primitive(x: NDArray) -> NDArray:
    """Integral of ln coth(|t| / 2) from 0 to x."""
    decay = np.exp(-np.abs(x))
    # By dilogarithms; spence(z) is Li2(1 - z).
    return np.sign(x) * (np.pi**2 / 4.0 - spence(1.0 - decay) + spence(1.0 + decay))
