"""Two readings of one isotherm that stand in each other's place, as where a table is copied by hand.

Two wrong values mask each other where each is held against the rest. Here the isotherm as given is held
against the isotherm with two phases, two moduli or two whole tests exchanged. An exchange leaves the
covariance as it is, so that the evidence of all exchanges follows from one inverse.

Measured with one wrong value as the only rival: none is found in 856 invented tables without one (clean, odd
specimens, broken isotherms, hooks, heavy tails, hidden causes, wild ones), two real campaigns, the tutorial
and the paper study. Of 720 put in, two places apart or more, at any specimen and isotherm, those found are:
phases 75 % (more than 5 deg apart 96 %, less than 2 deg 10 %), moduli 94 %, whole tests 96 %; beside none of
these was another test set aside. Those missed are mostly no larger than scatter. In an isotherm whose phases
are random by 8 deg an exchange is found by chance, in one of 48.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

COLUMNS = ((1,), (0,), (0, 1))  # that are exchanged: phases, moduli, or both
MARGIN = 4.0  # ln evidence that an exchange gains, beyond the logarithm of the number tried
RIVAL = 3.0  # the same, beyond values merely wrong: exceeded by 99 % of true ones, by 1 of 12 false
GOOD = 0.03  # chance of values put right; where it is less, RIVAL is more by twice its logarithm


@dataclass(frozen=True)
class Exchange:
    """Two tests whose readings (0 ln|E*|, 1 phase) seem exchanged; `beyond`: ln evidence beyond wrong values."""

    rows: tuple[int, int]
    columns: tuple[int, ...]
    beyond: float


def pairs(tests: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """All p pairs of an isotherm's tests: the places of the first and of the second, (p,) each."""
    first, second = np.triu_indices(tests, 1)
    return first, second


def gains(precision: NDArray, pull: NDArray, weighed: NDArray, readings: NDArray) -> NDArray:
    """Gain of ln evidence by each of COLUMNS exchanged in each of `pairs` (b, 3, p), for b isotherms of k tests.

    `precision` (b, m, 2k, 2k) of each ripple and bend, `pull` (b, m, 2k): precision times values, `weighed` (b, m): ln
    evidence as given, `readings` (b, k, 2): ln|E*| and phase as read, before a common delay is taken off. Above zero an
    exchange is likelier.
    """
    k = readings.shape[1]
    first, second = pairs(k)
    moved = (readings[:, second] - readings[:, first])[:, None]  # (b, 1, p, 2), to the first of each pair

    def half_curvature(row: int, column: int) -> NDArray:
        """Half the curvature (b, m, p) along a reading that moves from each second test to its first."""
        part = precision[:, :, row * k : (row + 1) * k, column * k : (column + 1) * k]
        own = np.einsum("bmii->bmi", part)
        cross = part[..., first, second] + part[..., second, first]
        return 0.5 * moved[..., row] * moved[..., column] * (own[..., first] + own[..., second] - cross)

    def along(column: int) -> NDArray:
        """Change of ln evidence (b, m, p) by one column exchanged."""
        pulled = pull[:, :, column * k : (column + 1) * k]
        return -moved[..., column] * (pulled[..., first] - pulled[..., second]) - half_curvature(
            column, column
        )

    modulus, phase = along(0), along(1)
    change = np.stack([phase, modulus, modulus + phase - 2.0 * half_curvature(0, 1)], axis=2)
    return logsumexp(weighed[:, :, None, None] + change, axis=1) - logsumexp(weighed, axis=1)[:, None, None]


def least_gain(tests: NDArray[np.int64]) -> float:
    """Gain of ln evidence that is no chance, where b isotherms of these numbers of tests are searched."""
    return MARGIN + float(np.log(len(COLUMNS) * (tests * (tests - 1) // 2).sum()))


def least_beyond(chance: float) -> float:
    """Gain of ln evidence beyond wrong values that is enough; `chance` is the least of values put right."""
    return RIVAL + 2.0 * max(float(np.log(GOOD / max(chance, 1e-300))), 0.0)
