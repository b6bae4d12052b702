"""Detection limits: an effect of that size, put in exactly, is seen in 19 of 20 tables."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_joint import ACTIVE, CAUSES, fit, table  # noqa: F401  fixtures

from asphalt_nscd.diagnosis.criteria import Z_95
from asphalt_nscd.diagnosis.model import chance
from asphalt_nscd.diagnosis.model.chance import Scores
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.search import limits

CHANCE_LEVEL = 3.5
THRESHOLD = CHANCE_LEVEL + Z_95


def limits_of(joint, fitted, candidates):
    directions = chance.candidate_directions(joint, fitted, candidates)
    confined = np.array([isinstance(one.place, str) for one in candidates])
    found = chance.scores(joint, fitted, directions, confined)
    return limits._scored_limits(joint, fitted, candidates, found, THRESHOLD)


@pytest.mark.parametrize("one", ACTIVE[:3], ids=lambda one: one.cause.name)
def test_power_at_the_limit_is_95_percent(fit, one):  # noqa: F811
    """Scatter is drawn and a law from its prior; the cause acts by its own formula, in its own unit."""
    joint, fitted = fit
    absent = one.replace_values(np.zeros(1))
    size = limits_of(joint, fitted, [absent])[0][one.key]
    modulus = np.exp(joint.predict(fitted))
    rows = one.cause.rows(joint.observed, one.place)
    changed = one.cause.apparent(modulus, np.array([size]), joint.observed)
    effect = joint.noise.whiten(np.where(rows, np.log(changed / modulus), 0.0))
    direction = chance.candidate_directions(joint, fitted, [absent])
    d = joint.noise.whiten(direction)[:, 0]
    random = np.random.default_rng(1)
    follows = np.linalg.solve(fitted.precision, fitted.jacobian.T)
    prior = fitted.precision - fitted.jacobian.T @ fitted.jacobian
    value, vector = np.linalg.eigh(prior)
    pulled = vector * np.sqrt(np.maximum(value, 0.0)) @ random.standard_normal((value.size, 4000))
    drawn = random.standard_normal((d.size, 4000)) + effect[:, None]
    # A law drawn from its prior moves what is left by as much as the prior pulls it back.
    left = drawn - fitted.jacobian @ (follows @ drawn) + follows.T @ pulled
    z = d @ left / np.sqrt(d @ (d - fitted.jacobian @ (follows @ d)))
    assert np.mean(z > CHANCE_LEVEL) == pytest.approx(0.95, abs=0.015)


def test_what_cannot_be_seen_has_no_limit_and_is_told(fit):  # noqa: F811
    joint, fitted = fit
    absent = [one.replace_values(np.zeros(1)) for one in (ACTIVE[0], ACTIVE[2])]
    directions = chance.candidate_directions(joint, fitted, absent)
    found = chance.scores(joint, fitted, directions, np.array([False, True]))
    blind = replace(found, seen=np.array([True, False]))
    sizes, unseen = limits._scored_limits(joint, fitted, absent, blind, THRESHOLD)
    assert [one.key for one in unseen] == [absent[1].key] and set(sizes) == {absent[0].key}


def test_a_limit_beyond_any_size_of_its_cause_is_none(table, fit):  # noqa: F811
    """A common offset of 280 deg was once told as a limit."""
    joint, fitted = fit
    absent = ACTIVE[0].replace_values(np.zeros(1))
    blurred = Joint(table, joint.base, replace(joint.noise, within=1e4 * joint.noise.within))
    sizes, unseen = limits_of(blurred, blurred.linearise(fitted.law, fitted.scales, ()), [absent])
    assert not sizes and unseen == [absent]


def test_the_law_is_fitted_again_where_it_leaves_less_than_a_twentieth_of_an_effect(fit, monkeypatch):  # noqa: F811
    joint, fitted = fit
    absent = [one.replace_values(np.zeros(1)) for one in ACTIVE[:2]]
    square = (joint.noise.whiten(chance.candidate_directions(joint, fitted, absent)) ** 2).sum(axis=0)
    refitted = []

    def by_refit(joint, fitted, candidate, size, threshold):
        refitted.append(candidate.key)
        return 2.0

    monkeypatch.setattr(limits, "_refit_ratio", by_refit)
    found = Scores(np.zeros(2), np.array([0.04, 0.06]) * square, np.ones(2, bool), np.eye(2))
    sizes, _ = limits._scored_limits(joint, fitted, absent, found, THRESHOLD)
    assert refitted == [absent[0].key]
    for one, factor, information in zip(absent, (2.0, 1.0), found.information, strict=True):
        assert sizes[one.key] == pytest.approx(factor * THRESHOLD / np.sqrt(information) * one.typical[0])


def test_an_effect_at_its_linear_limit_is_as_strong_as_the_threshold(fit):  # noqa: F811
    """A clamp of one specimen, which the law cannot follow: fitted without it, the misfit is the threshold squared."""
    joint, fitted = fit
    absent = ACTIVE[2].replace_values(np.zeros(1))
    size = limits_of(joint, fitted, [absent])[0][absent.key]
    assert limits._limit_ratio(joint, fitted, absent, size, THRESHOLD) == pytest.approx(1.0, rel=0.1)


def test_causes_are_alike_if_three_limits_do_not_part_them():
    """Of two directions with correlation r, that of z leaves z^2 (1 - r^2) to the other."""
    one, other = (Candidate(CAUSES[name], None, (0.0,)) for name in ("phase_offset", "channel_delay"))
    strongest = 3.0 * (3.7 + 1.645)
    for left, alike in ((5.0, True), (7.0, False)):
        r = np.sqrt(1.0 - left / strongest**2)
        assert bool(limits._alike([one, other], np.array([[1.0, r], [r, 1.0]]))) is alike
    same = [one, replace(one, values=(1.0,))]
    assert limits._alike(same, np.ones((2, 2))) == []


def test_a_fault_of_one_place_is_told_from_what_its_odds_need(monkeypatch):
    """Beyond four standard errors, or where half of z squared outweighs the odds against it, in 19 of 20 cases."""
    angle = Candidate(CAUSES["phase_offset"], None, (0.0,))
    survey = SimpleNamespace(candidates=[angle] * 3, pointing=None)
    state = SimpleNamespace(model=None, variances=None, plain=SimpleNamespace(observed=None))
    monkeypatch.setattr(limits.likelihood, "correlation", lambda *_: (None, np.array([0.4, 2.0, 8.0])))
    tried = []

    def odds(near, observed, gain, std_error):
        tried.append((near.values[0], gain, std_error))
        return -2.0 if std_error < 0.5 else -18.0

    monkeypatch.setattr(limits, "log_odds", odds)
    found = limits.place_limits(state, survey)
    assert tried == [(0.8, 0.0, 0.2), (4.0, 0.0, 1.0), (16.0, 0.0, 4.0)]  # typical: half a degree
    sizes = [1.6 * (4.0 + 1.645) * 0.2, 1.6 * (6.0 + 1.645) * 1.0]  # the third is beyond 30 deg
    assert [(one.values[0], error) for one, error in found] == [
        (pytest.approx(size), pytest.approx(error)) for size, error in zip(sizes, (0.2, 1.0))
    ]
    assert limits.place_limits(state, SimpleNamespace(candidates=[])) == []


def test_of_several_shapes_the_limit_is_that_which_nine_of_ten_do_not_exceed(fit, monkeypatch):  # noqa: F811
    joint, fitted = fit
    absent = ACTIVE[0].replace_values(np.zeros(1))
    monkeypatch.setattr(limits, "_refit_ratio", lambda *_: 1.0)
    found = Scores(np.zeros(11), np.linspace(1.0, 2.0, 11) ** -2.0, np.ones(11, bool), np.eye(11))
    sizes, _ = limits._scored_limits(joint, fitted, [absent] * 11, found, 5.0)
    assert sizes[absent.key] == pytest.approx(5.0 * 1.9 * absent.typical[0])
