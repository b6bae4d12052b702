"""Which test says most: designs known beforehand, and the gain against simulated answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm

from asphalt_nscd.diagnosis.next_tests.information import Inquiry, Knowledge, Linear, Question
from asphalt_nscd.diagnosis.next_tests.information import Tested as Sweep

SIGMA = 0.01
FREQUENCIES = 5


def single(*rows: int) -> Sweep:
    return Sweep(np.array(rows), SIGMA**2 * np.eye(2 * len(rows)))


def level_and_two_causes() -> Linear:
    """Five frequencies, tested once (rows 0-4) and to be tested (5-9): a free level, a cause that is an offset of the
    phase, and another that is the same but at the highest frequency."""
    nuisance = np.ones((2 * FREQUENCIES, 1), complex)
    offset = np.full(2 * FREQUENCIES, 0.01j)
    other = np.where(np.arange(2 * FREQUENCIES) % FREQUENCIES == 4, 0.02j, 0.01j)
    return Linear(nuisance, np.zeros((1, 1)), np.column_stack([offset, other]))


def asked(cause: int, amplitude: float, free: tuple, rows: int) -> Question:
    return Question(cause, amplitude, free, 1e9, np.ones(rows, bool))


def test_causes_that_differ_at_one_frequency_are_told_apart_there():
    question = asked(0, 1.0, (1,), 10)
    inquiry = Inquiry(level_and_two_causes(), single(*range(5)), [question])
    gains = inquiry.gains([single(row) for row in range(5, 10)])[:, 0]
    assert gains.argmax() == 4 and gains[4] > 1.5 * gains[:4].max()
    # Alone, the offset shows at every frequency alike.
    gains = Inquiry(level_and_two_causes(), single(*range(5)), [asked(0, 1.0, (), 10)]).gains(
        [single(row) for row in range(5, 10)]
    )[:, 0]
    assert gains == pytest.approx(np.full(5, gains[0]))


def test_an_offset_limited_by_the_freedom_of_one_isotherm_asks_for_that_isotherm():
    """An offset at the colder isotherm only, the phase of which was tested once; the warmer was tested ten times."""
    effects = np.array([0.01j, 0.0, 0.01j, 0.0])[:, None]
    linear = Linear(np.zeros((4, 1), complex), np.ones((1, 1)), effects)
    inquiry = Inquiry(linear, single(0, 1), [asked(0, 1.0, (), 4)])
    cold, warm = inquiry.gains([single(2), single(3)])[:, 0]
    assert cold == pytest.approx(0.5) and warm == 0.0


def test_information_of_old_and_new_tests_adds_up_to_that_of_all():
    rng = np.random.default_rng(1)
    nuisance, effects = (rng.standard_normal((9, k)) + 1j * rng.standard_normal((9, k)) for k in (4, 3))
    linear = Linear(nuisance, np.diag(rng.uniform(0.1, 2.0, 4)), effects)
    root = rng.standard_normal((8, 8))
    new = Sweep(np.arange(5, 9), 0.1 * root @ root.T + np.eye(8))
    old = Sweep(np.arange(5), np.eye(10))
    known = Knowledge(linear, [old])
    at_once = known.posterior(new).information
    assert known.information + known.gained([new])[0] == pytest.approx(at_once, rel=1e-9)
    # And by generalised least squares over everything at once.
    h, d = (
        np.concatenate([part.real[r], part.imag[r]]) for part in (nuisance, effects) for r in (slice(0, 9),)
    )
    order = np.concatenate([np.arange(5), np.arange(9, 14), np.arange(5, 9), np.arange(14, 18)])
    h, d = h[order], d[order]
    scatter = np.zeros((18, 18))
    scatter[:10, :10], scatter[10:, 10:] = np.eye(10), new.scatter
    wide = scatter + h @ np.linalg.inv(linear.precision) @ h.T
    assert at_once == pytest.approx(d.T @ np.linalg.solve(wide, d), rel=1e-6)


def test_knowledge_grows_test_by_test_as_from_all_at_once():
    """What is left to learn too: of a third set of tests the gain is the same either way."""
    rng = np.random.default_rng(2)
    nuisance, effects = (rng.standard_normal((12, k)) + 1j * rng.standard_normal((12, k)) for k in (5, 2))
    linear = Linear(nuisance, np.diag(rng.uniform(0.1, 2.0, 5)), effects)
    first, second, third = (Sweep(np.arange(k, k + 4), (1.0 + k) * np.eye(8)) for k in (0, 4, 8))
    step_by_step = Knowledge(linear, [first]).posterior(second).posterior(single(2))
    at_once = Knowledge(linear, [first, second, single(2)])
    assert step_by_step.information == pytest.approx(at_once.information, rel=1e-9)
    wanted = at_once.gained([third, single(9), first])
    assert step_by_step.gained([third, single(9), first]) == pytest.approx(wanted, rel=1e-7)


def test_following_the_advice_raises_the_power_as_promised():
    """The cause is drawn 4 000 times and sought by least squares, with the frequency asked for and with another one."""
    linear = level_and_two_causes()
    question = asked(0, 5.0, (1,), 10)
    inquiry = Inquiry(linear, single(*range(5)), [question])
    gains = inquiry.gains([single(row) for row in range(5, 10)])[:, 0]
    best, other = 5 + int(gains.argmax()), 5 + int(gains.argmin())
    found = {row: _power(linear, [0, 1, 2, 3, 4, *[row] * 3], question) for row in (best, other)}
    assert found[best] > found[other] + 0.05
    promised = Knowledge(linear, [single(0, 1, 2, 3, 4), *[single(best)] * 3]).information
    assert found[best] == pytest.approx(norm.sf(3.0 - np.sqrt(question.strength(promised))), abs=0.03)


def _power(linear: Linear, rows: list[int], question: Question) -> float:
    """Share of draws in which the amplitude of the first cause is three standard errors from zero."""
    design = np.column_stack([linear.effects[rows], linear.nuisance[rows]])
    design = np.concatenate([design.real, design.imag])
    truth = np.zeros(design.shape[1])
    truth[question.cause] = question.amplitude
    noise = SIGMA * np.random.default_rng(2).standard_normal((4000, design.shape[0]))
    covariance = SIGMA**2 * np.linalg.pinv(design.T @ design)
    estimate = (design @ truth + noise) @ design @ covariance.T / SIGMA**2
    return float(
        np.mean(estimate[:, question.cause] > 3.0 * np.sqrt(covariance[question.cause, question.cause]))
    )


def test_no_more_evidence_counts_than_is_needed():
    question = Question(0, 10.0, (), need=4.0, kept=np.ones(1, bool), weight=0.5)
    assert question.nats(np.array([[1.0]])) == 0.5 * 0.5 * 4.0
    assert question.strength(np.array([[1.0]])) == 100.0
