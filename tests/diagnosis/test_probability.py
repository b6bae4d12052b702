"""Odds of a cause against the integral over all its sizes, and shares of names that exclude each other."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import cauchy
from test_diagnose import table

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.criteria import EXPECTED
from asphalt_nscd.diagnosis.joint import Candidate
from asphalt_nscd.diagnosis.probability import log_odds, shares

CAUSES = {cause.name: cause for cause in CATALOGUE}


@pytest.mark.parametrize(
    "name,z", [("phase_offset", 4.0), ("temperature_bias", -6.0), ("guide_friction", 8.0)]
)
def test_odds_are_those_of_the_integral_over_all_sizes(name, z):
    observed = table(0)
    cause, expected = CAUSES[name], EXPECTED[name]
    error = 0.05 * expected.size
    best = z * error
    low = 0.0 if cause.parameters[0].low >= 0.0 else -np.inf
    density = cauchy(scale=expected.size).pdf

    def integrand(size):
        return np.exp(-0.5 * ((size - best) / error) ** 2) * density(size) / (1.0 - cauchy.cdf(low))

    ratio = np.exp(0.5 * z**2) * quad(integrand, max(low, best - 10.0 * error), best + 10.0 * error)[0]
    places = cause.places(observed)
    chance = expected.chance / len(places)
    exact = np.log(ratio * chance / (1.0 - chance))
    assert log_odds(Candidate(cause, places[0], (best,)), observed, z**2, error) == pytest.approx(
        exact, abs=0.1
    )


def test_a_size_that_is_not_known_at_all_tells_nothing():
    cause = CAUSES["phase_offset"]
    for error in (10.0, 1e6):
        assert log_odds(Candidate(cause, None, (0.0,)), table(0), 0.0, error) < np.log(
            EXPECTED[cause.name].chance
        )


def test_shares_leave_room_for_none_and_for_rivals():
    assert shares([0.0]).tolist() == pytest.approx([0.5])
    assert shares([30.0, 30.0]).tolist() == pytest.approx([0.5, 0.5])
    assert shares([3.0, -40.0]).tolist() == pytest.approx([1.0 / (1.0 + np.exp(-3.0)), 0.0], abs=1e-9)
    assert shares([]).size == 0
