"""Score tests and their chance, against dense algebra, simulation and known distributions."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from asphalt_nscd.diagnosis.model import chance
from asphalt_nscd.diagnosis.model.chance import Scores
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search import ladder

N, P, K = 15, 6, 4  # tests, parameters of the law, directions


@pytest.fixture
def model():
    """A linear law with a prior, a fit somewhere beside the best one, and directions of effects."""
    random = np.random.default_rng(3)
    jacobian = random.standard_normal((2 * N, P))
    prior = np.diag(random.uniform(0.2, 3.0, P))
    directions = random.standard_normal((N, K)) + 1j * random.standard_normal((N, K))
    joint = SimpleNamespace(noise=SimpleNamespace(whiten=lambda v: np.concatenate([v.real, v.imag])))
    return joint, jacobian, prior, directions


def fitted(jacobian, prior, residual, at):
    """Where the parameters stand `at`, of a law whose prior is about zero."""
    precision = jacobian.T @ jacobian + prior
    left = residual - jacobian @ at
    return SimpleNamespace(
        jacobian=jacobian, precision=precision, residual=left, gradient=jacobian.T @ left - prior @ at
    )


def test_the_square_of_a_score_is_what_the_objective_gains(model):
    """By least squares with one more column: objective of the law alone less that with the effect."""
    joint, jacobian, prior, directions = model
    random = np.random.default_rng(4)
    residual, at = random.standard_normal(2 * N), random.standard_normal(P)
    found = chance.scores(joint, fitted(jacobian, prior, residual, at), directions, np.zeros(K, bool))

    def objective(columns, penalty):
        root = np.vstack([columns, np.linalg.cholesky(penalty + 1e-12 * np.eye(len(penalty))).T])
        data = np.concatenate([residual, np.zeros(len(penalty))])
        best = np.linalg.lstsq(root, data, rcond=None)[0]
        return float(np.sum((data - root @ best) ** 2)), best

    alone = objective(jacobian, prior)[0]
    for k in range(K):
        d = joint.noise.whiten(directions[:, [k]])
        penalty = np.zeros((P + 1, P + 1))
        penalty[:P, :P] = prior
        with_effect, best = objective(np.hstack([jacobian, d]), penalty)
        assert found.z[k] ** 2 == pytest.approx(alone - with_effect, rel=1e-6)
        assert np.sign(found.z[k]) == np.sign(best[-1])
        assert found.z[k] / np.sqrt(found.information[k]) == pytest.approx(best[-1], rel=1e-5)


def test_scores_of_scatter_have_unit_variance_and_the_correlation_stated(model):
    joint, jacobian, prior, directions = model
    random = np.random.default_rng(5)
    draws = []
    for _ in range(4000):
        truth = np.linalg.cholesky(np.linalg.inv(prior)) @ random.standard_normal(P)
        residual = random.standard_normal(2 * N) + jacobian @ truth
        found = chance.scores(
            joint, fitted(jacobian, prior, residual, np.zeros(P)), directions, np.zeros(K, bool)
        )
        draws.append(found.z)
    assert np.cov(np.array(draws).T) == pytest.approx(found.correlation, abs=0.07)
    assert np.diag(found.correlation) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("left", "confined", "seen"),
    [(3.1e-3, False, True), (2.9e-3, False, False), (2e-9, True, True), (5e-10, True, False)],
)
def test_of_a_direction_the_law_must_leave_three_thousandths_of_its_square(left, confined, seen):
    """Along the one direction that the law has, of which its prior holds so much."""
    joint = SimpleNamespace(noise=SimpleNamespace(whiten=lambda v: np.concatenate([v.real, v.imag])))
    law = SimpleNamespace(
        jacobian=np.eye(6)[:, :1],
        precision=np.array([[1.0 / (1.0 - left)]]),
        residual=np.zeros(6),
        gradient=np.zeros(1),
    )
    found = chance.scores(joint, law, 2.0 * np.eye(3)[:, :1] + 0j, np.array([confined]))
    assert found.information[0] == pytest.approx(4.0 * left, rel=1e-6) and bool(found.seen[0]) is seen


@pytest.mark.parametrize(("one_sided", "freedom"), [(False, 9), (True, 9), (False, 10**6)])
def test_one_direction_alone_is_as_large_as_students_t(one_sided, freedom):
    drawn = chance.largest_by_chance(
        np.eye(1), np.array([one_sided]), freedom, 200_000, np.random.default_rng(7)
    )
    for share in (0.9, 0.99):
        t = stats.t(freedom).ppf(share if one_sided else 0.5 + share / 2)
        assert np.quantile(drawn, share) == pytest.approx(t, rel=0.02)


def test_the_largest_of_many_is_larger_and_of_equal_ones_is_not():
    random = np.random.default_rng(8)
    many = chance.largest_by_chance(np.eye(20), np.zeros(20, bool), 10**6, 100_000, random)
    wanted = stats.norm.ppf(0.5 + 0.5 * 0.95 ** (1 / 20))  # all of twenty below it
    assert np.quantile(many, 0.95) == pytest.approx(wanted, rel=0.01)
    drawn = chance.largest_by_chance(np.ones((20, 20)), np.zeros(20, bool), 10**6, 100_000, random)
    assert np.quantile(drawn, 0.95) == pytest.approx(1.96, rel=0.02)


def test_draws_of_a_seed_do_not_hang_on_the_signs_that_rounding_gives_eigenvectors():
    """Two pairs of scores alike: each eigenvalue is double, and any rotation of its eigenvectors is as good."""
    alike = np.kron(np.eye(2), np.array([[1.0, 0.6], [0.6, 1.0]]))
    rounding = 1e-12 * np.random.default_rng(0).standard_normal((4, 4))
    drawn = [
        chance.largest_by_chance(
            one,
            np.zeros(4, bool),
            100,
            1000,
            np.random.default_rng(8),
        )
        for one in (alike, alike + rounding + rounding.T)
    ]
    assert drawn[0] == pytest.approx(drawn[1], rel=1e-9)


def test_chance_of_a_score_is_the_share_of_draws_and_beyond_them_falls_like_the_normal_tail():
    drawn = stats.halfnorm.ppf((np.arange(4000) + 0.5) / 4000)  # as even as draws can be
    assert chance.tail(drawn, 1.96) == pytest.approx(0.05, abs=2.5e-4)
    for z in (3.5, 4.5, 6.0):
        assert chance.tail(drawn, z) == pytest.approx(2.0 * stats.norm.sf(z), rel=0.02)
    assert chance.tail(drawn, 0.0) == 1.0
    few = stats.halfnorm.ppf((np.arange(500) + 0.5) / 500)
    for share in (0.022, 0.018, 0.012, 0.004):  # eleven draws, and where the tail takes over
        assert chance.tail(few, stats.norm.isf(share / 2.0)) == pytest.approx(share, rel=0.05)


def test_nameless_patterns_are_what_their_names_say():
    grid = np.array([(s, t, f) for s in (0, 1) for t in (0.0, 30.0) for f in (1.0, 4.0)])
    specimen, t, f = grid.T
    table = Observations(
        specimen.astype(int),
        ("A", "B"),
        t,
        f,
        np.ones(8) + 0j,
        np.ones(8),
        np.zeros(8),
        order=np.arange(1.0, 9.0),
    )
    found = {one.name: one.direction for one in chance.structures(table)}
    above, log_f = t - 15.0, np.log(f) - np.log(2.0)
    expected = {
        "slope over frequency": log_f,
        "slope over temperature": above,
        "bend over frequency": log_f**2,
        "bend over temperature": above**2,
        "slope over frequency growing with temperature": log_f * above,
        "slope over frequency in warm tests": log_f * (t == 30.0) * 15.0,
        "warm tests": (t == 30.0) * 15.0,
        "1 Hz": f == 1.0,
        "4 Hz": f == 4.0,
        "above 1 Hz": f == 4.0,
        "0 degC": t == 0.0,
        "30 degC": t == 30.0,
        "0 degC, slope over frequency": log_f * (t == 0.0),
        "30 degC, slope over frequency": log_f * (t == 30.0),
        **{f"{a:g} degC, {b:g} Hz": (t == a) & (f == b) for a in (0.0, 30.0) for b in (1.0, 4.0)},
        "course of the tests": np.arange(8) - 3.5,
    }
    for k, name in enumerate(("specimen A", "specimen B")):
        of = specimen == k
        expected |= {name: of, f"{name}, slope over frequency": of * log_f}
        expected |= {f"{name}, slope over temperature": of * above}
    assert set(found) == {f"{name}, {part}" for name in expected for part in ("modulus", "phase")}
    for name, pattern in expected.items():
        assert found[f"{name}, modulus"] == pytest.approx(pattern.astype(complex)), name
        assert found[f"{name}, phase"] == pytest.approx(1j * pattern), name
    course = [
        one
        for one in chance.structures(replace(table, cycles=np.repeat([0.0, 1e4], 4)))
        if "course" in one.name
    ]
    assert course[0].direction == pytest.approx(np.repeat([-5e3 + 0j, 5e3], 4))


# two specimens at three frequencies, each test twice; freedom of the scatter
TWO = SimpleNamespace(
    observed=SimpleNamespace(
        specimen=np.repeat([0, 1], 6), frequency=np.tile([1.0, 3.0, 9.0], 4), names=("a", "b"), size=12
    ),
    noise=SimpleNamespace(freedom=10.0),
)


def test_a_law_that_takes_all_that_specimens_do_at_a_frequency_leaves_no_pattern(monkeypatch):
    """Each specimen at frequencies of its own: nothing is left of the directions, and once this was divided by none."""
    nothing = Scores(np.zeros(6), np.zeros(6), np.zeros(6, bool), np.zeros((6, 6)))
    monkeypatch.setattr(chance, "scores", lambda *_: nothing)
    assert ladder._interactions(TWO, None) == []


def test_modulus_and_phase_are_two_tries_of_one_chance(monkeypatch):
    """Scatter alone gets a p-value below 0.2 once in five tables, less the few where both tries do."""
    random = np.random.default_rng(9)

    def scatter(*_):
        z = random.standard_normal(6) / np.sqrt(random.chisquare(10) / 10)
        return Scores(z, np.ones(6), np.ones(6, bool), np.eye(6))

    monkeypatch.setattr(chance, "scores", scatter)
    least = [min(one.p_value for one in ladder._interactions(TWO, None)) for _ in range(4000)]
    assert np.mean(np.array(least) < 0.2) == pytest.approx(1 - 0.9**2, abs=0.02)
