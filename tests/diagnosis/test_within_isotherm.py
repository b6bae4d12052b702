"""What an isotherm says of one of its values, against the conditional distributions of a mixture, written out."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import f as fisher
from scipy.stats import multivariate_normal
from scipy.stats import t as student

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import within_isotherm
from asphalt_nscd.diagnosis.screening.kramers_kronig import WEIGHTS, covariances
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

FREQUENCY = np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0])
TEMPERATURES = (4.0, 15.0, 27.0, 40.0)
LAW = HuetSayegh(
    static_modulus=80e6, glassy_modulus=32e9, k=0.22, h=0.6, delta=2.3, tau=0.3, shift=WLF(18.0, 140.0, 15.0)
)


def table(specimens=3, delay=0.0, scatter=(0.01, 0.005), seed=1, temperatures=TEMPERATURES) -> Observations:
    random = np.random.default_rng(seed)
    grid = np.array([(s, t, f) for s in range(specimens) for t in temperatures for f in FREQUENCY])
    omega = 2.0 * np.pi * grid[:, 2]
    true = np.log(LAW.complex_modulus(omega, grid[:, 1])) + 1j * omega * delay
    true = (
        true
        + scatter[0] * random.standard_normal(omega.size)
        + 1j * scatter[1] * random.standard_normal(omega.size)
    )
    return Observations(
        grid[:, 0].astype(int), tuple("ABC"[:specimens]), grid[:, 1], grid[:, 2], np.exp(true),
        np.full(omega.size, 25e3), np.zeros(omega.size),
    )  # fmt: skip


def changed(observed: Observations, row: int, factor: complex) -> Observations:
    modulus = observed.modulus.copy()
    modulus[row] *= factor
    return Observations(**{**vars(observed), "modulus": modulus})


def test_each_value_is_expected_where_the_mixture_given_the_others_has_its_mean():
    """Every ripple and bend one normal distribution; weights by the density of the other values alone."""
    observed = table(specimens=1, temperatures=(15.0,))
    loo = within_isotherm._Table(observed).leave_one_out()
    k = FREQUENCY.size
    log_f = np.log(FREQUENCY)
    smooth = np.exp(-0.5 * ((log_f[:, None] - log_f) / within_isotherm.BEND_LENGTH) ** 2)
    scatter = np.repeat(np.square(within_isotherm.SCATTER), k)
    logarithm = observed.logarithm
    values = np.concatenate([logarithm.real - logarithm.real.mean(), logarithm.imag])
    models, weights = [], []
    for causal, ripple in zip(covariances(FREQUENCY), WEIGHTS):
        for bend, share in zip(within_isotherm.BENDS, within_isotherm.BEND_WEIGHTS):
            whole = causal + np.diag(scatter)
            whole[k:, k:] += within_isotherm.OFFSET**2 + bend**2 * smooth
            models.append(whole)
            weights.append(np.log(ripple * share))
    for place in range(2 * k):
        others = np.setdiff1d(np.arange(2 * k), place)
        logs, means, variances = [], [], []
        for whole, weight in zip(models, weights):
            part = whole[np.ix_(others, others)]
            logs.append(weight + multivariate_normal(cov=part).logpdf(values[others]))
            pull = np.linalg.solve(part, whole[others, place])
            means.append(pull @ values[others])
            variances.append(whole[place, place] - pull @ whole[others, place])
        share = np.exp(np.array(logs) - logsumexp(logs))
        mean = share @ means
        error = np.sqrt(share @ (np.array(variances) + (np.array(means) - mean) ** 2))
        test, column = place % k, place // k
        shift = logarithm.real.mean() if column == 0 else 0.0
        assert loo.expected[test, column] - shift == pytest.approx(mean, abs=2e-7)
        assert loo.std_error[test, column] == pytest.approx(error, rel=1e-4)
        z = np.abs(values[place] - np.array(means)) / np.sqrt(variances)
        assert loo.chance[test, column] == pytest.approx(share @ (2.0 * student(10.0).sf(z)), rel=1e-4)


def test_a_test_set_aside_is_judged_as_before():
    """Its own variance is not asked by the others; it is judged by its own scatter."""
    row, observed = 8, changed(table(), 8, np.exp(0.02 + 0.01j))
    chances = []
    for columns in ([], [0], [1], [0, 1]):
        one = within_isotherm._Table(observed)
        one.aside[row, columns] = True
        chances.append(one.leave_one_out().chance[row])
    as_it_is, modulus, phase, both = np.array(chances)
    assert (modulus[0], phase[1], both[2]) == pytest.approx(as_it_is, rel=1e-6) and 0.01 < as_it_is[2] < 0.99


def test_the_scatter_of_a_table_is_learnt():
    for scatter in ((0.006, 0.003), (0.03, 0.012)):
        found = [
            within_isotherm.leave_one_out(table(scatter=scatter, seed=seed)).scatter.mean(axis=0)
            for seed in range(6)
        ]
        # A tenth and a fifth too low, whatever the scatter: the law of each isotherm takes a part of it.
        assert np.mean(found, axis=0) / scatter == pytest.approx([0.9, 0.8], rel=0.05)


def test_expectations_miss_by_their_standard_errors():
    """Over tables drawn with scatter alone: of a hundred values some five are beyond two standard errors."""
    far = []
    for seed in range(12):
        observed = table(seed=10 + seed)
        loo = within_isotherm.leave_one_out(observed)
        logarithm = observed.logarithm
        left = np.column_stack([logarithm.real, logarithm.imag]) - loo.expected
        far.append(np.abs(left / loo.std_error) > 2.0)
    assert 0.02 < np.mean(far) < 0.09


def test_a_delay_of_all_tests_is_taken_off_and_is_in_what_is_expected():
    found = []
    for delay in (6e-4, -6e-4):
        observed = table(delay=delay)
        loo = within_isotherm.leave_one_out(observed)
        left = observed.logarithm.imag - loo.expected[:, 1]
        assert np.sqrt(np.mean(left**2)) < 0.02
        found.append(loo.delay)
    # Scatter, the same in both tables, looks like a delay of its own: too small to be taken off where it is alone.
    assert found[0] - found[1] == pytest.approx(1.2e-3, rel=0.03)
    assert abs(found[0] + found[1]) < 2e-4
    assert within_isotherm.leave_one_out(table()).delay == 0.0


@pytest.mark.parametrize(("factor", "column"), [(1.25, 0), (np.exp(0.07j), 1)])
def test_a_wrong_value_is_the_least_likely_and_expected_where_it_was(factor, column):
    row = 8  # specimen A, 15 degC, 1 Hz
    sound = table(seed=4)
    loo = within_isotherm.leave_one_out(changed(sound, row, factor))
    assert np.unravel_index(loo.chance[:, :2].argmin(), (sound.size, 2)) == (row, column)
    assert loo.chance[row, column] < 1e-3
    true = (sound.logarithm.real, sound.logarithm.imag)[column][row]
    assert loo.expected[row, column] == pytest.approx(true, abs=3.0 * loo.std_error[row, column])


def test_isotherms_of_three_tests_judge_nothing():
    observed = table()
    few = observed.subset(observed.frequency < 2.0)
    loo = within_isotherm.leave_one_out(few)
    assert not loo.judged.any() and (loo.chance == 1.0).all() and np.isnan(loo.expected).all()


def test_both_values_of_a_test_are_judged_together_by_the_others():
    """Ripples and bends weighed by the density of the other tests; Fisher's F of two values and their freedom."""
    observed = table(specimens=1, temperatures=(15.0,))
    made = within_isotherm._Table(observed)
    chance = made.leave_one_out().chance[:, 2]
    (group,) = made.groups
    k = FREQUENCY.size
    logarithm = observed.logarithm
    values = np.concatenate([logarithm.real - logarithm.real.mean(), logarithm.imag])
    scatter = np.diag(np.repeat(np.square(within_isotherm.SCATTER), k))
    for test in range(k):
        pair, logs, chances = [test, test + k], [], []
        others = np.setdiff1d(np.arange(2 * k), pair)
        for covariance, weight in zip(group.covariance, made.weights[0].ravel(), strict=True):
            whole = covariance + scatter
            part = whole[np.ix_(others, others)]
            logs.append(weight + multivariate_normal(cov=part).logpdf(values[others]))
            pull = np.linalg.solve(part, whole[np.ix_(others, pair)]).T
            left = values[pair] - pull @ values[others]
            spread = whole[np.ix_(pair, pair)] - pull @ whole[np.ix_(others, pair)]
            chances.append(fisher(2, 10.0).sf(0.5 * left @ np.linalg.solve(spread, left)))
        share = np.exp(np.array(logs) - logsumexp(logs))
        assert chance[test] == pytest.approx(share @ chances, rel=1e-4)


def test_a_delay_of_an_isotherm_is_the_mixture_of_generalised_least_squares():
    """Of each ripple and bend a flat prior of the delay; weighed by their evidence with it integrated out."""
    observed = table(specimens=1, temperatures=(15.0,), delay=5e-4)
    made = within_isotherm._Table(observed)
    (group,) = made.groups
    k, omega = FREQUENCY.size, 2.0 * np.pi * FREQUENCY
    logarithm = observed.logarithm
    values = np.concatenate([logarithm.real - logarithm.real.mean(), logarithm.imag])
    scatter = np.diag(np.repeat(np.square(within_isotherm.SCATTER), k))
    along = np.concatenate([np.zeros(k), omega])
    tried = np.linspace(-5e-3, 5e-3, 4001)
    density = np.zeros(tried.size)
    for covariance, weight in zip(group.covariance, made.weights[0].ravel(), strict=True):
        left = values - tried[:, None] * along
        density += np.exp(weight) * multivariate_normal(cov=covariance + scatter).pdf(left)
    mean = density @ tried / density.sum()
    error = np.sqrt(density @ (tried - mean) ** 2 / density.sum())
    found = made._delays(group, observed.omega)[:, 0]
    assert found == pytest.approx([mean, error], rel=1e-3)


@pytest.mark.parametrize(
    ("delays", "errors", "isotherms", "expected"),
    [
        ([3.0, 3.1, 2.9, 9.0], [0.5, 0.5, 0.5, 0.5], [0, 0, 10, 10], 3.0),  # the lower one in the middle
        ([3.0, 1.0, 1.1, 5.0], [0.1, 9.0, 9.0, 9.0], [0, 0, 10, 10], 3.0),  # weighed by one over the error
        (
            [3.0, 3.0, 3.0, 3.0],
            [1.7, 1.7, 1.7, 1.7],
            [0, 0, 10, 10],
            0.0,
        ),  # 1.253 times 0.85, three times that
        ([3.0, 3.0, 3.0, 3.0], [1.55, 1.55, 1.55, 1.55], [0, 0, 10, 10], 3.0),
        ([3.0, 2.0, 4.0, 3.0], [0.2, 0.2, 0.2, 0.2], [0, 0, 10, 10], 3.0),
        ([3.0, 1.4, 4.6, 3.0], [0.2, 0.2, 0.2, 0.2], [0, 0, 10, 10], 3.0),
        (
            [3.0, 0.0, 6.0, 6.0],
            [0.2, 0.2, 0.2, 0.2],
            [0, 0, 10, 10],
            0.0,
        ),  # they differ far beyond their errors
        ([3.0, 3.0, 3.0, 3.0], [0.1, 0.1, 0.1, 0.1], [0, 0, 0, 0], 0.0),  # one temperature
        ([3.0, 3.0, 3.0], [0.1, 0.1, 0.1], [0, 10, 20], 0.0),  # three isotherms
    ],
)
def test_a_delay_is_the_weighted_median_of_isotherms_where_it_is_three_of_its_errors(
    delays, errors, isotherms, expected
):
    first = np.arange(len(delays))
    made = SimpleNamespace(
        groups=[SimpleNamespace(first=first)], isotherm=np.array(isotherms),
        _delays=lambda group, omega: np.array([delays, errors]),
    )  # fmt: skip
    assert within_isotherm._Table.common_delay(made, None) == expected


def test_what_is_usual_is_learnt_from_the_table_and_bends_from_other_specimens():
    """The weights of the module are worth three isotherms; those of the table, for a bend, two."""
    evidence = np.full((3, 4, 5), -60.0)
    evidence[0, 0, 0] = evidence[1, 1, 3] = evidence[2, 1, 4] = 0.0  # each isotherm is sure of one
    made = SimpleNamespace(
        groups=[SimpleNamespace(first=np.arange(3))], weights=np.zeros((3, 4, 5)),
        isotherm=np.array([20.0, 20.0, 40.0]), specimen=np.array([0, 1, 0]),
    )  # fmt: skip
    within_isotherm._Table._learn_weights(made, SimpleNamespace(log_evidence=evidence))
    ripples = (3.0 * np.array(WEIGHTS) + [1.0, 2.0, 0.0, 0.0]) / 6.0
    bends = (3.0 * np.array(within_isotherm.BEND_WEIGHTS) + [1.0, 0.0, 0.0, 1.0, 1.0]) / 6.0
    usual = [2.0 * bends + np.eye(5)[3], 2.0 * bends + np.eye(5)[0], 2.0 * bends]
    for weights, of in zip(made.weights, usual, strict=True):
        assert np.exp(weights) == pytest.approx(np.outer(ripples, of / of.sum()))


def test_the_scatter_of_an_isotherm_is_drawn_to_the_common_one_by_what_it_knows():
    """DerSimonian and Laird's variance between isotherms, of the logarithm of each scatter."""
    isotherm = np.repeat([0.0, 10.0, 20.0], [12, 18, 24])
    weight, squares = np.ones((54, 2)), np.ones((54, 2))
    weight[::2, 0], squares[:12, 0], squares[30:, 1] = 0.5, 6.0, 0.12
    made = SimpleNamespace(
        judged=np.ones(54, bool), isotherm=isotherm, weight=weight, squares=squares,
        scatter=np.tile([0.02, 0.01], (54, 1)), freedom=np.zeros((54, 2)),
    )  # fmt: skip
    within_isotherm._Table._learn_scatter(made)
    for column, begin in enumerate((0.02, 0.01)):
        groups = [isotherm == t for t in (0.0, 10.0, 20.0)]
        sums = np.array(
            [[one[rows, column].sum() for one in (weight, weight**2, squares)] for rows in groups]
        )
        own = np.log(begin * np.clip(np.sqrt(sums[:, 2] / sums[:, 0] / 0.9205), 0.3, 3.0))
        chance = 0.5 * sums[:, 1] / (0.4 * sums[:, 0] ** 2)
        known = 1.0 / chance
        common = known @ own / known.sum()
        spread = known @ (own - common) ** 2 - 2.0
        between = max(spread, 0.0) / (known.sum() - known @ known / known.sum())
        share = between / (between + chance)
        expected = np.exp(common + np.clip(share * (own - common), np.log(0.5), np.log(3.0)))
        freedom = 0.5 * 2.5 / (share * chance + (1.0 - share) ** 2 / known.sum())
        for rows, size, count in zip(groups, expected, freedom, strict=True):
            assert made.scatter[rows, column] == pytest.approx(np.full(rows.sum(), size))
            assert made.freedom[rows, column] == pytest.approx(np.full(rows.sum(), count))
        assert between > 0.0
