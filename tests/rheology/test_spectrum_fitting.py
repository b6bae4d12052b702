"""One law for all temperatures, and how well the points know it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.priors import ASPHALT_CONCRETE, USUAL
from asphalt_nscd.rheology.shift import WLF, Arrhenius
from asphalt_nscd.rheology.spectrum import parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, _Problem, fit_spectrum

FREQUENCIES = 2 * np.pi * np.array([3.0, 6, 10, 25, 40])
TEMPERATURES = [-10.0, 5, 20, 40, 60]
OMEGA, TEMPERATURE = np.tile(FREQUENCIES, 5), np.repeat(TEMPERATURES, 5)
SPECTRUM = TwoS2P1D(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, WLF(11.7, 79.9, 15.0))
HUET = HuetSayegh(80e6, 42e9, 0.2, 0.6, 1.64, 0.14, WLF(11.7, 79.9, 15.0))
KINDS = {
    "2s2p1d-wlf": SPECTRUM,
    "huet-sayegh-wlf": HUET,
    "2s2p1d-arrhenius": replace(SPECTRUM, shift=Arrhenius(2e5, 15.0)),
    "huet-sayegh-arrhenius": replace(HUET, shift=Arrhenius(2e5, 15.0)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_each_law_is_found_from_a_grid_of_tests(kind):
    truth, (law, shift) = KINDS[kind], kind.rsplit("-", 1)
    fit = fit_spectrum(OMEGA, TEMPERATURE, truth.complex_modulus(OMEGA, TEMPERATURE), 15.0, Form(law, shift))
    assert type(fit.law) is type(truth) and type(fit.law.shift) is type(truth.shift)
    assert parameters(fit.law) == pytest.approx(parameters(truth), rel=1e-4)
    assert fit.unseen == () and fit.freedom == 50 - len(parameters(truth))


def test_reference_temperature_is_only_a_choice():
    scatter = 0.02 * np.random.default_rng(5).standard_normal(OMEGA.size)
    modulus = SPECTRUM.complex_modulus(OMEGA, TEMPERATURE) * np.exp(scatter)
    rms = [fit_spectrum(OMEGA, TEMPERATURE, modulus, reference).rms_log_residual for reference in (0.0, 25.0)]
    assert 0.01 < rms[0] < 0.03
    assert rms[0] == pytest.approx(rms[1], rel=1e-6)


def test_standard_errors_are_those_of_linear_regression():
    """noise sqrt(diag((J^T J)^-1)) with J by differences in the parameters themselves."""
    noise, repeats = 0.01, 60
    omega, temperature = np.tile(OMEGA, repeats), np.tile(TEMPERATURE, repeats)
    random = np.random.default_rng(4)
    scatter = noise * (random.standard_normal(omega.size) + 1j * random.standard_normal(omega.size))
    fit = fit_spectrum(
        omega,
        temperature,
        HUET.complex_modulus(omega, temperature) * np.exp(scatter),
        15.0,
        Form("huet-sayegh"),
    )

    def changed(name, factor):
        if name in ("c1", "c2"):
            return replace(HUET, shift=replace(HUET.shift, **{name: factor * getattr(HUET.shift, name)}))
        return replace(HUET, **{name: factor * getattr(HUET, name)})

    columns = []
    for name in parameters(HUET):
        high, low = (np.log(changed(name, 1 + d).complex_modulus(omega, temperature)) for d in (1e-5, -1e-5))
        slope = (high - low) / 2e-5
        columns.append(np.concatenate([slope.real, slope.imag]))
    jacobian = np.column_stack(columns)
    expected = noise * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    for (name, value), relative in zip(parameters(HUET).items(), expected, strict=True):
        assert fit.std_error[name] == pytest.approx(relative * value, rel=0.1)
        low, high = fit.interval(name, 0.999)
        assert low < value < high
        low, high = fit.interval(name, 0.5)  # t of 3000 degrees of freedom is normal: 0.674 each way
        assert np.log(high / low) == pytest.approx(2 * 0.674 * relative, rel=0.1)


def test_a_parameter_at_its_bound_is_unseen():
    """Without a static modulus in the data it has no error, and the others have that of a law without it."""
    truth = replace(HUET, static_modulus=0.0)
    scatter = 0.01 * np.random.default_rng(6).standard_normal((2, OMEGA.size))
    modulus = truth.complex_modulus(OMEGA, TEMPERATURE) * np.exp(scatter[0] + 1j * scatter[1])
    modulus[-5:] *= np.exp(0.05j)  # the hottest tests flow more freely than the law: static modulus to zero
    fit = fit_spectrum(OMEGA, TEMPERATURE, modulus, 15.0, Form("huet-sayegh"))
    assert fit.unseen == ("static_modulus",)
    assert set(fit.std_error) == set(parameters(truth)) - {"static_modulus"}
    assert all(0 < fit.std_error[name] < 0.5 * parameters(fit.law)[name] for name in fit.std_error)
    assert fit.freedom == 50 - 7


def test_of_a_straight_shift_the_slope_is_found_and_neither_c1_nor_c2():
    law = TwoS2P1D(1e6, 4e10, 0.2, 0.6, 1.7, 0.1, 30.0, WLF(0.12 * 1e5, 1e5, 15.0))
    omega, temperature = (
        x.ravel() for x in np.meshgrid(2 * np.pi * np.geomspace(1, 40, 6), np.linspace(-20, 40, 7))
    )
    fit = fit_spectrum(omega, temperature, law.complex_modulus(omega, temperature), 15.0)
    shift = fit.law.shift
    assert fit.rms_log_residual < 3e-3
    assert shift.c1 / shift.c2 == pytest.approx(0.12, rel=0.01)
    assert {"c1", "c2"} <= set(fit.unseen) and not {"c1", "c2"} & set(fit.std_error)


def test_too_few_points_give_no_standard_errors():
    few = [0, 7, 13, 24]
    fit = fit_spectrum(
        OMEGA[few],
        TEMPERATURE[few],
        HUET.complex_modulus(OMEGA[few], TEMPERATURE[few]),
        15.0,
        Form("huet-sayegh"),
    )
    assert fit.std_error is None


@pytest.mark.parametrize(("shift", "least"), [("wlf", 3), ("arrhenius", 2)])
def test_too_few_temperatures_for_a_shift_are_refused(shift, least):
    temperature = np.arange(FREQUENCIES.size) % (least - 1) * 10.0
    with pytest.raises(InputError, match=f"kind '{shift}' needs at least {least} temperatures"):
        fit_spectrum(
            FREQUENCIES,
            temperature,
            SPECTRUM.complex_modulus(FREQUENCIES, temperature),
            15.0,
            Form(shift=shift),
        )


def test_too_few_points_are_refused():
    with pytest.raises(InputError, match="3 points cannot determine 9 parameters; measure at least 5"):
        fit_spectrum(FREQUENCIES[:3], [0.0, 10.0, 20.0], np.full(3, 1e9 + 1e8j), 15.0)


def scattered(law, omega, temperature, size=0.01, seed=3):
    noise = np.random.default_rng(seed).standard_normal((2, omega.size))
    return law.complex_modulus(omega, temperature) * np.exp(size * (noise[0] + 1j * noise[1]))


def moves(law, omega, temperature):
    """Change of each parameter by the prior, in standard errors of the fit without it."""
    modulus = scattered(law, omega, temperature)
    alone = fit_spectrum(omega, temperature, modulus, 15.0)
    held = fit_spectrum(omega, temperature, modulus, 15.0, prior=ASPHALT_CONCRETE)
    assert alone.unseen == () == held.from_prior
    found, before = parameters(held.law), parameters(alone.law)
    return {name: (found[name] - before[name]) / alone.std_error[name] for name in found}


def test_a_prior_moves_what_the_tests_determine_by_less_than_a_standard_error():
    """A law at the edges of the published ranges, on the paper's grid."""
    law = replace(SPECTRUM, static_modulus=150e6, glassy_modulus=20e9, delta=3.5)
    for truth in (SPECTRUM, law):
        assert max(map(abs, moves(truth, OMEGA, TEMPERATURE).values())) < 1.0


def test_a_prior_pulls_an_undetermined_glassy_modulus_into_the_usual_range():
    """Of tests at 45-55 degC on a mix of 100 GPa, and of 12 GPa, only the soft end is seen."""
    omega, temperature = (
        x.ravel() for x in np.meshgrid(2 * np.pi * np.geomspace(0.1, 3, 5), [45.0, 50.0, 55.0])
    )
    found = []
    for glassy in (100e9, 12e9):
        modulus = scattered(replace(SPECTRUM, glassy_modulus=glassy), omega, temperature)
        fit = fit_spectrum(omega, temperature, modulus, 15.0, prior=ASPHALT_CONCRETE)
        assert "glassy_modulus" in fit.from_prior and "glassy_modulus" in fit.unseen
        assert fit.rms_log_residual < 0.016  # scatter alone is 0.014
        assert "glassy_modulus" not in (fit_spectrum(omega, temperature, modulus, 15.0).std_error or {})
        found.append(fit.law.glassy_modulus)
        usual = USUAL["glassy_modulus"]
        # The prior's, and a little less for what the soft end tells.
        assert 0.8 < fit.std_error["glassy_modulus"] / (usual.deviation * found[-1]) < 1.0
    assert all(20e9 < value < 50e9 for value in found)


@pytest.mark.parametrize(("weights", "guess", "worth"), [(None, 0.01, 2.0), ((1e-3, 1e-3), 0.0, 0.0)])
def test_the_scatter_beside_a_prior_is_that_of_the_residuals(weights, guess, worth):
    """Freedom is 2 n less the trace of d(law)/d(tests); a guess of 1 % counts as two residuals, weights as none."""
    omega, temperature = np.tile(FREQUENCIES[:3], 3), np.repeat([0.0, 10.0, 20.0], 3)
    modulus = scattered(SPECTRUM, omega, temperature, size=0.03)
    fit = fit_spectrum(omega, temperature, modulus, 15.0, prior=ASPHALT_CONCRETE, weights=weights)
    slopes = fit.law.log_slopes(omega, temperature)
    freedom = 2 * omega.size - np.trace(np.vstack([slopes.real, slopes.imag]) @ fit.response)
    assert 18 - 9 < fit.freedom == round(freedom)
    squares = omega.size * fit.rms_log_residual**2
    variance = (squares + worth * guess**2) / (freedom + worth)
    of_tests = variance * fit.response @ fit.response.T
    assert fit.covariance - fit.of_prior == pytest.approx(of_tests, rel=1e-3, abs=1e-9)
    size = np.sqrt(np.diag(fit.covariance))
    assert list(fit.std_error.values()) == pytest.approx(size * list(parameters(fit.law).values()))


def test_posterior_errors_cover_the_truth():
    """Truth drawn from the prior, tests that leave half of it open: errors in posterior deviations are of unit size."""
    random = np.random.default_rng(8)
    omega, temperature = np.tile(FREQUENCIES, 3), np.repeat([0.0, 10.0, 20.0], 5)
    scores = []
    for seed in range(30):
        drawn = {name: u.median * np.exp(u.deviation * random.standard_normal()) for name, u in USUAL.items()}
        shift = WLF(drawn["wlf_slope"] * drawn["c2"], drawn["c2"], 15.0)
        own = {name: drawn[name] for name in ("static_modulus", "glassy_modulus", "k", "delta", "beta")}
        truth = TwoS2P1D(**own, h=min(drawn["h"], 0.9), tau=0.1, shift=shift)
        modulus = scattered(truth, omega, temperature, seed=seed)
        fit = fit_spectrum(
            omega,
            temperature,
            modulus,
            15.0,
            prior=ASPHALT_CONCRETE,
            weights=(0.01, np.full(omega.size, 0.01)),
        )
        for name, value in parameters(truth).items():
            found = parameters(fit.law)[name]
            scores.append(np.log(found / value) / (fit.std_error[name] / found))
    assert 0.8 < np.sqrt(np.mean(np.square(scores))) < 1.25


def test_weights_are_standard_deviations():
    """Twice the stated scatter gives twice the errors; a test of large scatter no longer counts."""
    modulus = scattered(SPECTRUM, OMEGA, TEMPERATURE)
    one, two = (fit_spectrum(OMEGA, TEMPERATURE, modulus, 15.0, weights=(s, s)) for s in (0.02, 0.04))
    assert parameters(one.law) == pytest.approx(parameters(two.law), rel=1e-5)
    assert one.std_error["k"] == pytest.approx(two.std_error["k"] / 2, rel=1e-5)
    alone, small = (
        fit_spectrum(OMEGA, TEMPERATURE, modulus, 15.0),
        (1e-3, 1e-3),
    )  # less than the residuals show
    assert fit_spectrum(OMEGA, TEMPERATURE, modulus, 15.0, weights=small).std_error == pytest.approx(
        alone.std_error, rel=1e-4
    )
    wrong, size = modulus.copy(), np.full(modulus.size, 0.01)
    wrong[7] *= 1.5 * np.exp(0.3j)
    size[7] = 100.0
    left = fit_spectrum(OMEGA, TEMPERATURE, wrong, 15.0, weights=(size, size)).law
    kept = np.arange(modulus.size) != 7
    without = fit_spectrum(OMEGA[kept], TEMPERATURE[kept], modulus[kept], 15.0).law
    assert parameters(left) == pytest.approx(parameters(without), rel=1e-3)
    with pytest.raises(InputError, match="standard deviation of a test is not positive"):
        fit_spectrum(OMEGA, TEMPERATURE, modulus, 15.0, weights=(0.01, 0.0))


def test_of_several_optima_the_lowest_is_taken():
    """Whatever the order in which the starts lead to them."""
    costs = iter([3.0, 1.0, 2.0, 5.0, 4.0])
    problem = SimpleNamespace(solve=lambda start: SimpleNamespace(cost=next(costs), start=start))
    assert _Problem.best(problem, list(range(5))).start == 1
