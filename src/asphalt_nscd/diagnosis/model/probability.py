"""The probability of each name: one cause more against none, and against every other cause that may stand in its place.

Near its best size a a cause has the likelihood ratio exp(gain/2) over none. Integrated over the sizes that it may have,
of prior density p(a), that is worth exp(gain/2) p(a) sqrt(2 pi) times its standard error (Laplace). The density is a
Cauchy's with the usual size of the cause, so that a large error is not held to be impossible.

These odds take it that what holds is in the catalogue, and an effect that it lacks can look like a cause. So the
probability that is stated holds what else speaks for or against a name, and is calibrated on drawn tables.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logit, logsumexp

from asphalt_nscd.diagnosis.causes._cause import Expected
from asphalt_nscd.diagnosis.criteria import DOUBTED, HALF_FROM, SUREST
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Observations


def log_odds(candidate: Candidate, observed: Observations, gain: float, std_error: float) -> float:
    """ln odds of a cause at its place over none; `gain` of -2 ln likelihood, other parameters fitted."""
    places = len(candidate.cause.places(observed))
    return odds_of(
        candidate.cause.expected, places, candidate.values[0], std_error, gain, candidate.cause.one_sided
    )


def odds_of(
    expected: Expected, places: int, size: float, std_error: float, gain: float, one_sided: bool = False
) -> float:
    """ln of the odds of an effect of this size, in the unit of what is expected, at one of several places.

    Gain / 2 + ln(p(a) sqrt(2 pi) std_error) + ln of the prior odds; `gain` is twice the gain of the log likelihood over
    none. `std_error` counts as the usual size where it is larger; if `one_sided`, the prior density is twice as large.
    """
    ways = 2.0 if one_sided else 1.0  # one sign alone has twice the density
    density = ways / (np.pi * expected.size * (1.0 + (size / expected.size) ** 2))
    chance = expected.chance / places
    # A size known worse than by its prior has the width of the prior.
    known = min(std_error, expected.size)
    return float(
        0.5 * gain + np.log(density * known * np.sqrt(2.0 * np.pi)) + np.log(chance / (1.0 - chance))
    )


def shares(odds: Sequence[float]) -> NDArray[np.float64]:
    """Probability (k,) of each of several names of which at most one holds, from ln odds (k,) over none."""
    return np.asarray(np.exp(np.array(odds) - logsumexp([0.0, *odds])))


def stated(modelled: float, established: bool, doubted: bool) -> float:
    """Probability of a name as stated, at most the model's: the share of names like it that are right in drawn tables.

    A doubt, that an effect outside the catalogue stands behind it (`diagnosis.search.doubts`), halves what its ln odds
    exceed HALF_FROM by.
    """
    most = min(modelled, SUREST[established])
    if not doubted:
        return most
    return min(most, float(expit(0.5 * (logit(modelled) - HALF_FROM))), DOUBTED)
