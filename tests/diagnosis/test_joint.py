"""The joint model: derivatives against differences, the fit against another minimiser."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import chi2, f

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model import start
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search import diagnose as chain
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


def test_a_stated_scatter_judges_the_misfit_by_chi_squared(fit):
    """96 values, of which the law and the scales take up what the hat matrix says."""
    joint, fitted = fit
    hat = fitted.jacobian @ np.linalg.solve(fitted.precision, fitted.jacobian.T)
    left = chi2(fitted.residual.size - np.trace(hat))
    assert joint.noise.freedom == scatter.STATED
    assert misfit_p_value(fitted, joint.noise) == pytest.approx(
        left.sf(fitted.residual @ fitted.residual), rel=1e-9
    )


HALF_USED = SimpleNamespace(  # ten directions, each of them half held by a prior: five parameters
    residual=np.full(40, 1.2), jacobian=np.eye(40)[:, :10], precision=2.0 * np.eye(10)
)


@pytest.mark.parametrize("freedom", [12, 15])
def test_replicates_judge_the_misfit_by_fisher_s_f(freedom):
    """57.6 of 40 values, of which pure error has its freedom, and the law five."""
    lack = 40 - 5 - freedom
    expected = f(lack, freedom).sf((57.6 - freedom) / lack)
    assert misfit_p_value(HALF_USED, SimpleNamespace(freedom=freedom)) == pytest.approx(expected)
    assert misfit_p_value(HALF_USED, SimpleNamespace(freedom=35)) == 1.0


def test_a_law_pays_the_logarithm_of_the_tests_for_each_parameter():
    assert chain._information(HALF_USED) == pytest.approx(57.6 + 5.0 * np.log(40.0))


def test_a_scatter_by_residuals_counts_what_the_law_has_used():
    """Of twenty moduli the law has used five, of twenty phases none."""
    (modulus, phase), freedom = chain._residual_scatter(HALF_USED, (0.02, 0.01))
    assert modulus == pytest.approx(0.02 * 1.2 * np.sqrt(20.0 / 15.0)) and phase == pytest.approx(0.01 * 1.2)
    assert freedom == 35
    assert chain._residual_scatter(HALF_USED, (1e-5, 1e-5))[0] == (1e-4, 1e-4)


def test_residuals_of_a_condition_are_means_over_the_scatter_of_a_mean():
    left = np.array([0.02 + 0.01j, 0.04 - 0.01j, 0.0 + 0.03j, 0.01, 0.01, 0.01, 0.01])
    observed = SimpleNamespace(cell=np.array([0, 0, 1, 2, 2, 2, 2]), logarithm=5.0 + left)
    found = SimpleNamespace(
        observed=observed,
        ladder=SimpleNamespace(fitted=SimpleNamespace(modelled=5.0)),
        noise=SimpleNamespace(sigma=(0.01, 0.005)),
    )
    mean, z = chain.cell_residuals(found)
    assert mean == pytest.approx([0.03, 0.03j, 0.01])
    assert z == pytest.approx([3.0 * np.sqrt(2.0), 6.0, 1.0 * 2.0])


@pytest.mark.parametrize(
    ("remaining", "law", "replicated", "doubts", "rungs", "spectrum", "verdict"),
    [
        (0.0024, 0.5, True, {}, [1], True, "unexplained_structure"),
        (0.0026, 0.5, True, {}, [1], False, "explained"),
        (0.5, 0.0024, True, {}, [], True, "unexplained_structure"),
        (0.5, 0.0026, True, {}, [], True, "explained"),
        (0.5, 0.0024, False, {}, [], True, "explained"),
        (None, 0.5, True, {"x": []}, [1], True, "unexplained_structure"),
        (None, 0.5, True, {}, [], False, "nothing_to_explain"),
    ],
)
def test_either_of_two_tests_at_half_the_chance_leaves_something_unexplained(
    remaining, law, replicated, doubts, rungs, spectrum, verdict
):
    left = None if remaining is None else SimpleNamespace(p_value=remaining)
    found = SimpleNamespace(
        ladder=SimpleNamespace(remaining=left, rungs=rungs), replicated=replicated, law_p=law, doubts=doubts,
        relaxation_spectrum=spectrum,
    )  # fmt: skip
    assert chain._verdict(found) == verdict


@pytest.mark.parametrize(
    ("replicated", "frequencies", "isotherms", "said"),
    [
        (False, 5, 5, "nothing was repeated"),
        (True, 2, 5, "two freq"),
        (True, 3, 3, "fewer than 4"),
        (True, 3, 4, ""),
    ],
)
def test_what_lacks_to_tell_a_cause_for_sure(replicated, frequencies, isotherms, said):
    observed = SimpleNamespace(frequencies=np.zeros(frequencies), isotherms=np.zeros(isotherms))
    found = chain._too_few(SimpleNamespace(observed=observed, replicated=replicated))
    assert found.startswith(said) and bool(found) == bool(said)
