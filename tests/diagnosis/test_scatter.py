"""Sizes of replicate scatter, against tables whose scatter is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import bartlett, norm
from scipy.stats import f as fisher

from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations

TEMPERATURES, FREQUENCIES = (-10.0, 4.0, 21.0, 37.0, 54.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)


def observed(random, specimens=4, within=(0.01, 0.004), shared=(0.0, 0.0), warm=1.0) -> Observations:
    """Specimens about one modulus for each condition; warm: scatter of the warmest isotherm over the others."""
    grid = np.array([(s, t, f) for s in range(specimens) for t in TEMPERATURES for f in FREQUENCIES])
    specimen, temperature = grid[:, 0].astype(int), grid[:, 1]
    sweep = specimen * len(TEMPERATURES) + np.searchsorted(TEMPERATURES, temperature)
    size = np.where(temperature == TEMPERATURES[-1], warm, 1.0)
    parts = [
        size * (single * random.standard_normal(sweep.size) + common * random.standard_normal(sweep.max() + 1)[sweep])
        for single, common in zip(within, shared, strict=True)
    ]  # fmt: skip
    true = np.log(1e9 * (60.0 - temperature) * grid[:, 2] ** 0.2) + 0.3j
    ones = np.ones(sweep.size)
    return Observations(
        specimen, tuple("ABCDEFGH"[:specimens]), temperature, grid[:, 2],
        np.exp(true + parts[0] + 1j * parts[1]), 25e3 * ones, 0.0 * ones,
    )  # fmt: skip


def estimated(table: Observations):
    noise = scatter.estimate(table, np.zeros((table.size, 0)), np.zeros(len(table.names)))
    assert noise is not None
    return noise


def test_what_a_mounting_shares_and_what_single_tests_scatter_by_are_told_apart():
    """Means over tables of both variances are those that the tables were drawn with."""
    random = np.random.default_rng(1)
    within, shared = np.array([0.01, 0.004]), np.array([0.01, 0.004])
    found = [estimated(observed(random, within=within, shared=shared)) for _ in range(150)]
    single = np.mean([(noise.within**2).mean(axis=1) for noise in found], axis=0)
    common = np.mean([(noise.shared**2).mean(axis=1) for noise in found], axis=0)
    assert single == pytest.approx(within**2, rel=0.12)
    assert common == pytest.approx(shared**2, rel=0.15)
    sigma = np.mean([noise.sigma for noise in found], axis=0)
    assert sigma == pytest.approx(np.hypot(within, shared), rel=0.06)


def test_residuals_are_what_is_left_of_each_condition_without_what_specimens_may_differ_by():
    random = np.random.default_rng(4)
    table = observed(random, specimens=3)
    modulus, phase, freedom = scatter.pure_error(table, np.zeros((table.size, 0)))
    for part, value in ((modulus, table.logarithm.real), (phase, table.logarithm.imag)):
        of_cell = [value[table.cell == cell].mean() for cell in table.cell]
        assert part == pytest.approx(value - of_cell, abs=1e-12)
    conditions = len(TEMPERATURES) * len(FREQUENCIES)
    assert freedom == 2 * (table.size - conditions)
    levels = (np.eye(3)[table.specimen]).astype(complex)
    modulus, _, freedom = scatter.pure_error(table, levels)
    assert freedom == 2 * (table.size - conditions) - 2
    by_hand = table.logarithm.real - [table.logarithm.real[table.cell == cell].mean() for cell in table.cell]
    by_hand -= np.array([by_hand[table.specimen == k].mean() for k in range(3)])[table.specimen]
    assert modulus == pytest.approx(by_hand, abs=1e-12)


def test_scatter_is_stated_from_degrees_of_freedom_that_the_residuals_have_left():
    """Two specimens, with a level each taken out: half of the squares are gone, the variance is not."""
    random = np.random.default_rng(5)
    levels = lambda table: np.eye(2)[table.specimen].astype(complex)  # noqa: E731
    tables = [observed(random, specimens=2) for _ in range(100)]
    found = [scatter.estimate(table, levels(table), np.zeros(2)) for table in tables]
    assert np.mean([noise.sigma[0] ** 2 for noise in found]) == pytest.approx(1e-4, rel=0.06)


def test_nothing_repeated_is_no_scatter():
    table = observed(np.random.default_rng(6), specimens=1)
    assert scatter.estimate(table, np.zeros((table.size, 0)), np.zeros(1)) is None


def test_scale_of_specimens_joins_what_is_usual_and_what_the_table_shows():
    """Eight degrees of freedom of 3 % against those of the table."""
    table = observed(np.random.default_rng(7), specimens=5)
    for spread in (0.0, 0.1, 0.4):
        scales = spread * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
        noise = scatter.estimate(table, np.zeros((table.size, 0)), scales)
        wanted = np.sqrt((8 * 0.03**2 + 4 * (1.4826 * spread) ** 2) / 12)
        assert noise is not None and noise.scale == pytest.approx(wanted, rel=1e-6)
    assert scatter._scale(np.array([0.4])) == pytest.approx(0.03)  # one says nothing, two not which is off
    assert scatter._scale(np.array([0.4, -0.4])) == pytest.approx(0.03 * np.sqrt(8.0 / 9.0))


def test_a_stated_scatter_is_taken_as_it_is():
    table = observed(np.random.default_rng(8))
    noise = scatter.stated(table, 0.03, 0.01, 0.05)
    assert noise.sigma == (0.03, 0.01) and not noise.shared.any() and noise.scale == 0.05
    assert (noise.within[0] == 0.03).all() and (noise.within[1] == 0.01).all()
    assert np.unique(noise.block).size == 4 * len(TEMPERATURES)


def graded(size):
    """Ten residuals whose mean is zero."""
    return size * norm.ppf((np.arange(10) + 0.5) / 10.0)


def test_isotherms_have_a_scatter_each_where_bartlett_s_test_says_so():
    """Each of ten residuals has nine degrees of freedom; then each has its own over the root of the mean square."""
    temperature, shares = np.repeat([0.0, 10.0, 20.0], 10), 10.0 / 9.0
    chances = []
    for warm in (3.0, 3.2):
        groups = [graded(one) for one in (1.0, 1.1, warm)]
        chances.append(bartlett(*groups).pvalue)
        squares = np.array([np.mean(one**2) for one in groups])
        expected = np.ones(30) if chances[-1] > 1e-3 else np.repeat(np.sqrt(squares / squares.mean()), 10)
        found = scatter._isotherm_scatter(np.concatenate(groups), temperature, shares)
        assert found == pytest.approx(expected)
    assert 5e-4 < chances[1] < 1e-3 < chances[0] < 5e-3
    few = np.concatenate([graded(1.0)[:3], graded(9.0)])  # two degrees of freedom are not enough
    assert (scatter._isotherm_scatter(few, np.repeat([0.0, 10.0], [3, 10]), shares) == 1.0).all()


def test_blocks_share_a_scatter_where_their_means_spread_beyond_chance():
    """Five blocks of four, each residual less by half of its freedom: variances of both by analysis of variance."""
    inner = np.tile([-3.0, -1.0, 1.0, 3.0], 5)
    block, share = np.repeat(np.arange(5), 4), 2.0
    within = 2.0 * (inner @ inner) / 15.0
    for size, beyond in ((2.6, False), (2.8, True)):
        means = size * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
        residual = inner + means[block]
        between = 2.0 * 4.0 * (means @ means) / 5.0
        assert bool(fisher(2.5, 7.5).sf(between / within) < 0.01) is beyond
        expected = (within, (between - within) / 4.0) if beyond else (2.0 * residual @ residual / 20.0, 0.0)
        assert scatter._components(residual, block, share) == pytest.approx(expected)
