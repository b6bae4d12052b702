"""Odds of a cause against the integral over all its sizes, and shares of names that exclude each other."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import expit
from scipy.stats import cauchy
from test_diagnose import EFFECTS, table

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.criteria import HALF_FROM, NAMED, SUREST
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.model.probability import log_odds, shares, stated
from asphalt_nscd.diagnosis.record.report import diagnosis_content
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.simulation.simulated import read_specimen

CAUSES = {cause.name: cause for cause in CATALOGUE}


@pytest.mark.parametrize(
    "name,z", [("phase_offset", 4.0), ("temperature_bias", -6.0), ("guide_friction", 8.0)]
)
def test_odds_are_those_of_the_integral_over_all_sizes(name, z):
    observed = table(0)
    cause, expected = CAUSES[name], CAUSES[name].expected
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
        assert log_odds(Candidate(cause, None, (0.0,)), table(0), 0.0, error) < np.log(cause.expected.chance)


def test_shares_leave_room_for_none_and_for_rivals():
    assert shares([0.0]).tolist() == pytest.approx([0.5])
    assert shares([30.0, 30.0]).tolist() == pytest.approx([0.5, 0.5])
    assert shares([3.0, -40.0]).tolist() == pytest.approx([1.0 / (1.0 + np.exp(-3.0)), 0.0], abs=1e-9)
    assert shares([]).size == 0


MODELLED = np.array([0.0, 1e-9, 0.1, 0.4, 0.5, 0.6, 0.8, 0.9, 0.95, 0.97, 0.99, 0.9999, 1.0 - 1e-12, 1.0])


@pytest.mark.parametrize(
    "established,doubted,most", [(True, False, 0.98), (False, False, 0.96), (False, True, 0.82)]
)
def test_a_stated_probability_rises_with_that_of_the_model_to_its_ceiling(established, doubted, most):
    told = np.array([stated(one, established, doubted) for one in MODELLED])
    assert (np.diff(told) >= 0.0).all() and (np.diff(told[told < most]) > 0.0).all()
    assert told[0] == 0.0 and told[-1] == most and (told <= MODELLED).all()


def test_an_established_name_keeps_its_probability_and_a_doubt_halves_the_odds():
    assert stated(0.96, True, False) == 0.96 and SUREST[True] > NAMED
    assert stated(0.9, False, False) == 0.9
    even = expit(HALF_FROM)
    assert stated(even, False, True) == pytest.approx(0.5)
    further = stated(expit(HALF_FROM + 2.0), False, True)
    assert np.log(further / (1.0 - further)) == pytest.approx(1.0)


@pytest.mark.slow
def test_the_report_states_the_calibrated_probability():
    """A whole table establishes an angle; on three of its isotherms its size may differ between frequencies."""
    whole = table(3, EFFECTS["phase_offset", None][1])
    few = diagnose(whole.subset(np.flatnonzero(np.isin(whole.temperature, [-10.0, 10.0, 30.0]))))
    (rung,) = few.ladder.rungs
    assert few.doubts.keys() == {rung.candidate.key} and rung.probability > SUREST[False]

    def told(found):
        (one,) = [
            one
            for one in diagnosis_content(found, read_specimen())["ladder"]
            if one["cause"] == "phase_offset"
        ]
        return one["established"], one["probability"]

    assert told(diagnose(whole)) == (True, SUREST[True])
    assert told(few) == (False, stated(rung.probability, False, True))
    few.ladder.doubts = {}
    assert told(few) == (False, SUREST[False])
