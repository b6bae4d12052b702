"""The joint model: derivatives against differences, the fit against another minimiser."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import chi2

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model import start
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search.diagnose import misfit_p_value
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

LAW = HuetSayegh(
    static_modulus=80e6, glassy_modulus=32e9, k=0.22, h=0.6, delta=2.3, tau=0.3, shift=WLF(18.0, 140.0, 15.0)
)
CAUSES = {cause.name: cause for cause in CATALOGUE}
ACTIVE = (
    Candidate(CAUSES["phase_offset"], None, (0.8,)),
    Candidate(CAUSES["moving_mass"], None, (0.15,)),
    Candidate(CAUSES["loose_clamp"], "B", (3e-12,)),
    Candidate(CAUSES["temperature_bias"], 10.0, (0.7,)),
)


@pytest.fixture(scope="module")
def table() -> Observations:
    random = np.random.default_rng(2)
    grid = np.array(
        [(s, t, f) for s in range(3) for t in (-5.0, 10.0, 25.0, 40.0) for f in (1.0, 3.0, 10.0, 30.0)]
    )
    omega = 2.0 * np.pi * grid[:, 2]
    log_modulus = (
        np.log(LAW.complex_modulus(omega, grid[:, 1])) + np.array([-0.05, 0.0, 0.08])[grid[:, 0].astype(int)]
    )
    log_modulus = (
        log_modulus + 0.01 * random.standard_normal(omega.size) + 0.004j * random.standard_normal(omega.size)
    )
    return Observations(
        grid[:, 0].astype(int), ("A", "B", "C"), grid[:, 1], grid[:, 2], np.exp(log_modulus),
        np.full(omega.size, 25e3), np.zeros(omega.size),
    )  # fmt: skip


@pytest.fixture(scope="module")
def fit(table):
    return start.fit_spectrum(table, scatter.stated(table, 0.01, 0.004, 0.03))


def moved(joint, fitted, step):
    """Law, scales and causes moved by a step, in the order of the parameters."""
    p, s = fitted.law.size, fitted.scales.size
    values = [
        c.replace_values(np.array(c.values) + x * c.typical) for c, x in zip(fitted.active, step[p + s :])
    ]
    return joint.linearise(fitted.law + step[:p], fitted.scales + step[p : p + s], tuple(values))


def test_jacobian_and_gradient_are_those_of_differences(fit):
    joint, fitted = fit
    at = joint.linearise(fitted.law + 0.01, fitted.scales + 0.02, ACTIVE)
    random = np.random.default_rng(1)
    for _ in range(6):
        step = random.standard_normal(at.gradient.size) * 1e-4
        ahead, behind = moved(joint, at, step), moved(joint, at, -step)
        change = 0.5 * (behind.residual - ahead.residual)
        assert np.linalg.norm(change - at.jacobian @ step) < 2e-3 * np.linalg.norm(change)
        assert 0.25 * (behind.objective - ahead.objective) == pytest.approx(
            at.gradient @ step, rel=2e-3, abs=1e-5
        )


def test_objective_is_squares_over_scatter_and_priors(table, fit):
    joint, fitted = fit
    left = table.logarithm - joint.predict(fitted)
    prior = joint.base.prior(fitted.law)[0]
    by_hand = (left.real**2).sum() / 0.01**2 + (left.imag**2).sum() / 0.004**2
    by_hand += prior @ prior + (fitted.scales**2).sum() / 0.03**2
    assert fitted.objective == pytest.approx(by_hand, rel=1e-9)
    assert fitted.scales - fitted.scales.mean() == pytest.approx([-0.06, -0.01, 0.07], abs=0.012)


def test_no_other_minimiser_finds_less(fit):
    joint, fitted = fit
    free = tuple(one for one in ACTIVE if one.cause.parameters[0].low < 0.0)
    best = joint.fit(fitted.law, fitted.scales, free)
    size = 1.0 / np.sqrt(np.diag(best.precision))
    other = minimize(
        lambda x: moved(joint, best, x * size).objective,
        np.zeros(size.size),
        jac=lambda x: -2.0 * moved(joint, best, x * size).gradient * size,
        method="BFGS",
        options={"maxiter": 60},
    )
    assert best.objective - other.fun < 0.02
    assert best.objective < joint.linearise(fitted.law, fitted.scales, free).objective - 1.0


def test_a_cause_is_fitted_with_the_size_that_was_put_in(table, fit):
    _, fitted = fit
    noise = scatter.stated(table, 0.01, 0.004, 0.03)
    for active in ACTIVE:
        changed = active.cause.apparent(table.modulus, np.array(active.values), table)
        if active.cause.name == "temperature_bias":
            warm = table.temperature + 0.7 * (table.temperature == 10.0)
            changed = table.modulus * LAW.complex_modulus(table.omega, warm)
            changed = changed / LAW.complex_modulus(table.omega, table.temperature)
        rows = active.cause.rows(table, active.place)
        shown = Joint(replace(table, modulus=np.where(rows, changed, table.modulus)), fit[0].base, noise)
        found = shown.fit(fitted.law, fitted.scales, (active.replace_values(np.zeros(1)),))
        error = np.sqrt(found.covariance[-1, -1]) * active.typical[0]
        without = Joint(table, fit[0].base, noise).fit(
            fitted.law, fitted.scales, (active.replace_values(np.zeros(1)),)
        )
        own = without.active[0].values[0]
        assert abs(found.active[0].values[0] - own - active.values[0]) < 0.6 * error, active.cause.name
        assert abs(own) < 3.5 * error


def test_the_scale_of_a_specimen_does_not_scale_the_mass_of_the_head(fit):
    joint, fitted = fit
    mass = Candidate(CAUSES["moving_mass"], None, (0.3,))
    scales = np.array([0.0, 0.4, -0.2])
    plain = joint.apparent(fitted.law, ())[0] * np.exp(scales)[joint.observed.specimen]
    with_mass = joint.apparent(fitted.law, (mass,), scales)[0]
    assert with_mass - plain == pytest.approx(-25e3 * 0.3 * joint.observed.omega**2, rel=1e-6)


def test_what_is_left_out_is_predicted_by_the_others(table, fit):
    joint, fitted = fit
    rows = np.flatnonzero((table.temperature == 10.0) & (table.frequency == 3.0))
    spoilt = table.modulus.copy()
    spoilt[rows] *= 1.5
    other = Joint(replace(table, modulus=spoilt), joint.base, joint.noise)
    off = (
        joint.predict(other.refit_without(rows, fitted))
        - np.log(LAW.complex_modulus(table.omega, table.temperature))
    )[rows]
    assert np.abs(off - np.array([-0.05, 0.0, 0.08])).max() < 0.03  # as if they had not been spoilt


def test_the_noise_of_some_rows_is_that_part_of_the_whole(table):
    noise = scatter.stated(table, 0.01, 0.004, 0.03)
    shared = replace(noise, shared=np.tile([[0.02], [0.001]], table.size))
    same = shared.block[:, None] == shared.block
    rows = np.array([0, 1, 5, 20, 21, 40])
    values = np.random.default_rng(0).standard_normal((rows.size, 2)) + 0j
    white = shared.subset(rows).whiten(values)
    dense = (1e-4 * np.eye(table.size) + 4e-4 * same)[np.ix_(rows, rows)]
    assert white.T @ white == pytest.approx(values.real.T @ np.linalg.solve(dense, values.real), rel=1e-9)


def test_noise_with_a_discrepancy_is_that_of_the_dense_covariance():
    """The squares of whitened values, and the determinant, of one block with a common share and two processes."""
    random = np.random.default_rng(3)
    n = 5
    within, shared = np.full((2, n), 0.02), np.full((2, n), 0.03)
    factor = 0.1 * random.standard_normal((2 * n, 2))
    noise = Noise(within, shared, np.zeros(n, int), (0.02, 0.02), 0.1, 9, factor)
    values = random.standard_normal(n) + 1j * random.standard_normal(n)
    own = np.kron(np.eye(2), 0.02**2 * np.eye(n) + 0.03**2)
    covariance = own + factor @ factor.T
    stacked = np.concatenate([values.real, values.imag])
    white = noise.whiten(values)
    assert white @ white == pytest.approx(stacked @ np.linalg.solve(covariance, stacked), rel=1e-9)
    assert noise.log_determinant == pytest.approx(np.linalg.slogdet(covariance)[1], rel=1e-9)


def test_a_stated_scatter_judges_the_misfit_by_chi_squared(fit):
    """96 values, of which the law and the scales take up what the hat matrix says."""
    joint, fitted = fit
    hat = fitted.jacobian @ np.linalg.solve(fitted.precision, fitted.jacobian.T)
    left = chi2(fitted.residual.size - np.trace(hat))
    assert joint.noise.freedom == scatter.STATED
    assert misfit_p_value(fitted, joint.noise) == pytest.approx(
        left.sf(fitted.residual @ fitted.residual), rel=1e-9
    )
