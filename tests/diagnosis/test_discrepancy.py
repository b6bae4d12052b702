"""The discrepancy's algebra against dense matrices and finite differences."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from asphalt_nscd.diagnosis.model import discrepancy, likelihood
from asphalt_nscd.diagnosis.model.arrowhead import Arrowhead
from asphalt_nscd.diagnosis.model.discrepancy import Process, Processes
from asphalt_nscd.diagnosis.model.likelihood import Direction, Reduced
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations

SIZE, PARTS, COLUMNS = 20, 4, 12


@pytest.fixture
def random():
    return np.random.default_rng(5)


def noise(random) -> Noise:
    block = np.repeat(np.arange(5), 4)
    ratio = random.uniform(0.1, 2.0, (2, 5))[:, block]
    within = random.uniform(0.5, 2.0, (2, 5))[:, block]
    return Noise(within, ratio * within, block, (1.0, 1.0), 0.1, 30)


def test_what_is_whitened_beside_a_discrepancy_has_the_inverse_of_its_covariance(random):
    plain = noise(random)
    factor = random.standard_normal((2 * SIZE, 7)) * np.geomspace(1e-4, 1e3, 7)
    wide = replace(plain, discrepancy=factor)
    same = plain.block[:, None] == plain.block
    dense = factor @ factor.T
    for k in (0, 1):
        at = slice(k * SIZE, (k + 1) * SIZE)
        dense[at, at] += np.diag(plain.within[k] ** 2) + np.outer(plain.shared[k], plain.shared[k]) * same
    values = random.standard_normal((SIZE, 3)) + 1j * random.standard_normal((SIZE, 3))
    both = np.concatenate([values.real, values.imag])
    white = wide.whiten(values)
    assert white.T @ white == pytest.approx(both.T @ np.linalg.solve(dense, both), rel=1e-7)
    assert wide.log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], rel=1e-9)
    rows = np.array([0, 1, 5, 9, 13])
    every = np.concatenate([rows, rows + SIZE])
    part = wide.subset(rows).whiten(values[rows])
    wanted = both[every].T @ np.linalg.solve(dense[np.ix_(every, every)], both[every])
    assert part.T @ part == pytest.approx(wanted, rel=1e-7)


def test_a_factor_of_distinct_points_gives_the_kernel_of_all_tests():
    points = np.array([[0.0], [1.0], [np.nan], [1.0], [3.0], [0.0], [0.0]])
    kernel = discrepancy.factor_of(points, lambda apart: 0.3 + np.exp(-0.5 * apart[0] ** 2), 1e-12)
    reached = np.isfinite(points[:, 0])
    apart = points - points.T
    wanted = np.where(reached[:, None] & reached, 0.3 + np.exp(-0.5 * apart**2), 0.0)
    assert kernel @ kernel.T == pytest.approx(wanted, abs=1e-12)
    assert kernel.shape[1] == 3


def test_shares_of_a_process_make_its_unit_variance():
    """A quarter at all frequencies, six tenths smooth over 1.5 of ln f, the rest of one condition."""
    frequency, isotherm = np.tile([1.0, np.exp(1.5)], 4), np.repeat([0.0, 20.0], 4)
    table = Observations(
        np.zeros(8, int), ("A",), isotherm, frequency, np.ones(8) + 0j, np.ones(8), np.zeros(8)
    )
    found = {process.isotherm: (points, kernel) for process, points, kernel in discrepancy._kernels(table)}
    for isotherm, level, reached in ((0.0, 0.25, 4), (None, 0.0, 8)):
        root = discrepancy.factor_of(*found[isotherm], 1e-12)[:reached]
        apart = level + 0.6 * np.exp(-0.5)
        expected = np.where(frequency[:reached, None] == frequency[:reached], level + 0.75, apart)
        assert root @ root.T == pytest.approx(expected, abs=1e-12)


def test_what_a_specimen_has_of_its_own_changes_over_three_of_ln_f_and_half_of_the_temperatures():
    """Half of its variance is the same in all of its tests; of the other specimen it reaches none."""
    grid = np.array([(s, t, f) for s in (0, 1) for t in (0.0, 10.0, 40.0) for f in (1.0, np.exp(1.5))])
    table = Observations(
        grid[:, 0].astype(int),
        ("A", "B"),
        grid[:, 1],
        grid[:, 2],
        np.ones(12) + 0j,
        np.ones(12),
        np.zeros(12),
    )
    (_, *of_one), (_, *of_other) = (one for one in discrepancy._kernels(table) if one[0].kind == "specimen")
    root = discrepancy.factor_of(*of_one, 1e-12)
    away = ((np.log(grid[:6, 2, None]) - np.log(grid[:6, 2])) / 3.0) ** 2
    away += ((grid[:6, 1, None] - grid[:6, 1]) / 20.0) ** 2
    assert root[:6] @ root[:6].T == pytest.approx(0.5 + 0.5 * np.exp(-0.5 * away), abs=1e-12)
    assert not root[6:].any() and not discrepancy.factor_of(*of_other, 1e-12)[:6].any()


def test_sizes_are_in_units_of_the_scatter_and_a_spectrum_moves_both_parts():
    """Of a law of which a relative change of each element by one moves ln E* by its share of the modulus."""
    table = Observations(
        np.repeat([0, 1], 4), ("A", "B"), np.tile([0.0, 0.0, 20.0, 20.0], 2), np.tile([1.0, 9.0], 4),
        np.ones(8) + 0j, np.ones(8), np.zeros(8),
    )  # fmt: skip
    random = np.random.default_rng(3)
    shares = random.random((8, 6)) + 1j * random.random((8, 6))
    times = np.geomspace(1e-3, 1e2, 6)
    base = SimpleNamespace(modulus=lambda *_: (np.full(8, 2.0 + 0j), np.hstack([2.0 * shares, shares])))
    joint = SimpleNamespace(
        observed=table, base=base, spectrum=SimpleNamespace(times=times),
        noise=SimpleNamespace(sigma=(0.02, 0.005), whiten=lambda x: np.vstack([x.real, x.imag])),
    )  # fmt: skip
    found = discrepancy.processes(joint, SimpleNamespace(law=None))
    roots = {(one.kind, one.part, one.specimen): root for one, root in zip(found.described, found.roots)}
    apart = np.log(times)[:, None] - np.log(times)
    expected = 0.02**2 * shares @ np.exp(-0.5 * (apart / 4.0) ** 2) @ shares.conj().T
    expected *= (table.specimen == 1)[:, None] & (table.specimen == 1)
    spectrum = roots["spectrum", "both", "B"]
    assert spectrum @ spectrum.conj().T == pytest.approx(expected, abs=0.02 * np.abs(expected).max())
    of_modulus, of_phase = (roots["all", part, None] for part in ("modulus", "phase"))
    assert (of_modulus**2).sum(axis=1) == pytest.approx(np.full(8, 0.02**2 * 0.75), rel=1e-3)
    assert of_phase == pytest.approx(0.25j * of_modulus)
    usual = {(one.kind, one.part): size for one, size in zip(found.described, found.usual)}
    assert usual["isotherm", "phase"] == 0.5 and usual["all", "modulus"] == 0.1
    assert usual["specimen", "modulus"] == 0.3 and usual["spectrum", "both"] == 1.0


def small(random) -> tuple[Reduced, Direction]:
    """A model of four processes and one cause, and data that hold both."""
    u, d, y = (random.standard_normal((40, k)) for k in (COLUMNS, 1, 1))
    y = y + 2.0 * d + u @ random.standard_normal((COLUMNS, 1)) * 0.7
    block = np.repeat(np.arange(PARTS), COLUMNS // PARTS)
    roots = tuple(np.zeros((20, COLUMNS // PARTS), complex) for _ in range(PARTS))
    found = Processes(
        tuple(Process("all", part) for part in "abcd"),
        roots,
        u,
        block,
        np.array([0.5, 0.1, 0.3, 1.0]),
        np.array([np.inf, 0.4, np.inf, 0.6]),
    )
    whole = Arrowhead(u.T @ u, np.zeros((0, COLUMNS)), np.full(COLUMNS, -1))
    model = Reduced(found, whole, (u.T @ y)[:, 0])
    return model, Direction(u.T @ d, d.T @ d, (d.T @ y)[:, 0])


def test_curvature_and_slope_are_those_of_finite_differences(random):
    model, cause = small(random)
    variances = np.array([0.4, 0.02, 1.3, 0.1])
    curvature, along = likelihood._curvature(model, cause, variances)

    def objective(log_v):
        return likelihood._point(model, cause, log_v).objective

    def slope(log_v):
        step = 1e-4 * np.eye(PARTS)
        return np.array([objective(log_v + e) - objective(log_v - e) for e in step]) / 2e-4

    log_v = np.log(variances)
    numeric = np.array([slope(log_v + e) - slope(log_v - e) for e in 1e-3 * np.eye(PARTS)]) / 2e-3
    assert curvature == pytest.approx(numeric, rel=1e-3, abs=1e-4)
    amplitude = approx_fprime(log_v, lambda x: likelihood._point(model, cause, x).amplitude, 1e-6)
    assert along == pytest.approx(amplitude, rel=1e-3, abs=1e-6)


def test_two_steps_that_shrink_by_one_factor_lead_to_their_limit_at_once(monkeypatch):
    """SQUAREM is exact where each step is the same share of the one before."""
    limit, tried = np.log([0.01, 0.3, 0.002]), []

    def point(model, cause, log_v, factor=None):
        tried.append(log_v)
        left = limit - log_v
        known = {"misfit": 0.0, "amplitude": 0.0, "std_error": 1.0}
        return SimpleNamespace(objective=float(left @ left), step=0.25 * left, **known)

    monkeypatch.setattr(likelihood, "_point", point)
    processes = SimpleNamespace(usual=np.full(3, 0.1), known=np.zeros(3, bool))
    model = SimpleNamespace(processes=processes, kept_factor=lambda variances: None)
    found = likelihood.estimate(model)
    np.testing.assert_allclose(found.variances, np.exp(limit), rtol=1e-12)
    np.testing.assert_allclose(tried[3], limit, rtol=1e-12)  # after the usual ones and two steps
