"""Data that meet Tables 3 and 4, and what smooth data can meet."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares

from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum import parameters
from studies.paper.consistent import draws, nearest
from studies.paper.smooth_bounds import Printed, least_scatter, log_slopes, phase_error
from studies.paper.smoothness import printed

PAPER = Path(__file__).parents[3] / "data/paper"
OMEGA = 2.0 * np.pi * np.array([3.0, 6.0, 10.0, 25.0, 40.0])
SMOOTH = TwoS2P1D(30e6, 36e9, k=0.2, h=0.58, delta=2.2, tau=0.06, beta=250.0, shift=WLF(12.0, 90.0, 15.0))


@pytest.fixture(scope="module")
def known():
    return [one for _, one in printed(PAPER / "table3_burgers.csv", PAPER / "table4_errors.csv")]


def missed(law, data):
    """Mean relative errors of norm and phase of a law, both E*."""
    return np.abs(np.abs(law / data) - 1.0).mean(), np.abs(np.angle(law / data) / np.angle(data)).mean()


def of_smooth_data(temperature):
    data = SMOOTH.complex_modulus(OMEGA, temperature)
    law = fit_burgers(OMEGA, data).law
    return Printed(law, OMEGA, *missed(law.complex_modulus(OMEGA), data))


@pytest.mark.parametrize("temperature", [5.0, 20.0])
def test_bounds_hold_the_errors_of_smooth_data_and_ask_no_scatter_of_them(temperature):
    true = of_smooth_data(temperature)
    assert phase_error(true, largest=False) < true.phase_error < phase_error(true, largest=True)
    assert least_scatter(true) < 1e-6


def test_a_weight_of_the_phase_is_that_of_its_squares_in_the_fit():
    data, weight = SMOOTH.complex_modulus(OMEGA, 20.0), 0.3

    def residual(log):
        missed = np.log(Burgers(*np.exp(log)).complex_modulus(OMEGA) / data)
        return np.concatenate([missed.real, np.sqrt(weight) * missed.imag])

    start = np.log(list(parameters(fit_burgers(OMEGA, data).law).values()))
    law = Burgers(*np.exp(least_squares(residual, start, xtol=1e-15, ftol=1e-15, gtol=1e-12).x))
    errors = missed(law.complex_modulus(OMEGA), data)
    assert (
        least_scatter(Printed(law, OMEGA, *errors, weight))
        < 1e-6
        < 1e-4
        < least_scatter(Printed(law, OMEGA, *errors))
    )


def test_errors_beyond_the_bounds_ask_for_scatter():
    true = of_smooth_data(20.0)
    least = phase_error(true, largest=False)
    beyond = Printed(true.law, OMEGA, true.error, 0.6 * least)
    scatter = least_scatter(beyond)
    # |phase| of some test must move by the mean of what is missing, at least: 0.4 of the error, in rad
    shift = 0.35 * least * np.angle(true.law.complex_modulus(OMEGA)).min()
    assert shift < scatter < 0.03


def test_no_smooth_data_have_the_printed_errors_at_15_degrees(known):
    """With phase and norm alike in the fit: smooth data miss the phase by 9 to 11 %, not by 5.47 %."""
    at = known[3]
    assert phase_error(at, largest=False) > 1.5 * at.phase_error
    assert 0.005 < least_scatter(at) < 0.02


def test_slopes_are_those_of_the_law():
    law = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
    slopes = log_slopes(law, OMEGA)
    # all stresses and viscosities times one factor: the norm follows, the phase stays
    np.testing.assert_allclose(slopes.sum(axis=1), np.repeat([1.0, 0.0], 5), atol=1e-8)
    # 1/E* = 1/Em + ...: d ln E* / d ln Em = E*/Em
    expected = law.complex_modulus(OMEGA) / law.modulus_m
    np.testing.assert_allclose(slopes[:, 0], [*expected.real, *expected.imag], atol=1e-8)


def test_draws_have_table_3_as_their_fit_and_table_4_as_its_errors(known):
    about = np.log(np.array([SMOOTH.complex_modulus(OMEGA, t) for t in (-10, 0, 10, 15, 20, 30)]))
    two = draws(known, about, 0.01, 2, seed=1)
    np.testing.assert_array_equal(two[0], draws(known, about, 0.01, 1, seed=1)[0])
    assert np.abs(two[0] - two[1]).max() > 0.005
    for one, data in zip(known, np.exp(two[0]), strict=True):
        np.testing.assert_allclose(missed(one.modulus, data), (one.error, one.phase_error), atol=2e-6)
    # the fit of this repository, which minimises the same, finds the law again
    law = fit_burgers(OMEGA, np.exp(two[0][3])).law
    assert law.modulus_m == pytest.approx(known[3].law.modulus_m, rel=1e-3)
    assert law.viscosity_k == pytest.approx(known[3].law.viscosity_k, rel=1e-3)


def test_data_are_found_although_an_error_changes_its_sign_on_the_way(known):
    """From the corners of |error| alone 53 are found, and on one processor not those of the paper study."""
    about, noise = (
        np.log(SMOOTH.complex_modulus(OMEGA, -10.0)),
        np.random.default_rng(1).standard_normal((60, 2, 5)),
    )
    wanted = about + 0.015 * (noise[:, 0] + 1j * noise[:, 1])
    assert sum(nearest(known[0], one) is not None for one in wanted) >= 57
