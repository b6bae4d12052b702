"""Values of one isotherm that are merely wrong: one, two, a whole test or two tests, by marginal likelihood.

A value far off bends what the others ask for, and two of them hide each other, where each is held against the rest
alone. Here the isotherm as given is held against the isotherm without a set of values; those may then be anything
(`WIDE`). All sets follow from one inverse: the values left out have the precision that the whole gives them.
"""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from asphalt_nscd.diagnosis.observed.observations import Observations

WIDE = 0.3, 0.2  # standard deviations of ln|E*| and of the phase [rad] that are merely wrong
RARE = float(np.log(0.01))  # ln odds of one wrong value, and of a second one in the same test
WITH_IT = float(np.log(0.3))
SURE = float(np.log(20.0))  # ln odds at which a set is taken out
LEAST_FOR_TWO = 5  # tests of an isotherm, of which two may be wrong
TEN = float(np.log(10.0))  # of ln|E*|
NEAR_TEN = 0.6  # of ln|E*|, by which phases tell |E*| to first order, broken isotherms too
ASTRAY = float(np.log(3.0))  # of ln|E*|, by which the other specimens must say so too


@cache
def _sets(tests: int) -> tuple[tuple[NDArray[np.int64], float], ...]:
    """Sets (p, s) of values of one size, moduli first, then phases, with their ln odds before the data speak."""
    values = range(2 * tests)
    found = [(np.array([[value] for value in values]), RARE)]
    found.append((np.array([[test, test + tests] for test in range(tests)]), RARE + WITH_IT))
    # Of four, the two that are wrong are as well ordered as the two that are right.
    if tests >= LEAST_FOR_TWO:
        apart = [pair for pair in combinations(values, 2) if pair[1] - pair[0] != tests]
        found.append((np.array(apart), 2.0 * RARE))
        whole = [(i, i + tests, j, j + tests) for i, j in combinations(range(tests), 2)]
        found.append((np.array(whole), 2.0 * (RARE + WITH_IT)))
    return tuple(found)


def likeliest(
    precision: NDArray, pull: NDArray, weighed: NDArray, room: int
) -> list[tuple[float, NDArray[np.int64]]]:
    """For each of b isotherms of k tests the likeliest set of wrong values: its ln odds over none, and the values.

    Values are numbered moduli first, then phases. `precision` (b, m, 2k, 2k) of each ripple and bend, `pull` (b, m,
    2k): precision times values, `weighed` (b, m): ln evidence as given, `room`: tests that may be wrong at once.
    """
    tests = pull.shape[2] // 2
    whole = logsumexp(weighed, axis=1)[:, None]
    best: list[tuple[float, NDArray[np.int64]]] = [(-np.inf, np.zeros(0, np.int64))] * pull.shape[0]
    for sets, before in _sets(tests):
        if np.unique(sets[0] % tests).size > room:
            continue
        own = precision[:, :, sets[:, :, None], sets[:, None, :]]
        along = pull[:, :, sets]
        square = (along * np.linalg.solve(own, along[..., None])[..., 0]).sum(axis=-1)
        without = weighed[:, :, None] + 0.5 * square - 0.5 * np.linalg.slogdet(own)[1]
        size = np.log(np.array(WIDE))[sets // tests].sum(axis=1)
        odds = logsumexp(without, axis=1) - whole - size + before
        for number, place in enumerate(odds.argmax(axis=1)):
            if odds[number, place] > best[number][0]:
                best[number] = float(odds[number, place]), sets[place]
    return best


def expected_of_tens(observed: Observations) -> dict[int, float]:
    """|E*| [Pa] expected of tests, by row, that are ten times what their sweep asks for, or a tenth.

    The cause is a decimal point. Every other test of the sweep must say so, by the phase of both (Kramers and Kronig to
    first order), and the other specimens, where they have the condition. No error of a test does that.
    """
    modulus, phase = observed.logarithm.real, observed.logarithm.imag
    found = {}
    for k, t in np.unique(np.column_stack([observed.specimen, observed.isotherm]), axis=0):
        rows = np.flatnonzero((observed.specimen == k) & (observed.isotherm == t))
        log_f, mean = np.log(observed.frequency[rows]), 0.5 * (phase[rows, None] + phase[rows])
        asked = modulus[rows] + mean * (2.0 / np.pi) * (log_f[:, None] - log_f)
        for place in range(rows.size):
            row, others = int(rows[place]), np.delete(asked[place], place)
            off = modulus[row] - others
            same = (observed.cell == observed.cell[row]) & (observed.specimen != k)
            # Of two tests without replicates neither is known to be the wrong one.
            if off.size < (1 if same.any() else 2):
                continue
            beyond = modulus[row] - np.median(modulus[same]) if same.any() else off[0]
            if (np.abs(np.abs(off) - TEN) < NEAR_TEN).all() and beyond * np.sign(off).mean() > ASTRAY:
                found[row] = float(np.exp(np.median(others)))
    return found
