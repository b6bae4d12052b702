"""Fits find the law that made the data, and say how well they know it."""

from dataclasses import astuple, replace

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.fitting import best_of_starts, fit_burgers

OMEGA = 2 * np.pi * np.array([3.0, 6, 10, 25, 40])
LAWS = {-10: Burgers(39.8e9, 62.8e9, 956e9, 14.9e9), 30: Burgers(13.0e9, 0.345e9, 9.31e9, 0.131e9)}
NAMES = ("modulus_m", "viscosity_m", "modulus_k", "viscosity_k")


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_exact_data_give_the_law_back(law):
    fit = fit_burgers(OMEGA, law.complex_modulus(OMEGA))
    np.testing.assert_allclose(astuple(fit.law), astuple(law), rtol=1e-6)
    assert fit.rms_log_residual < 1e-8


def test_standard_errors_are_those_of_linear_regression():
    """noise sqrt(diag((J^T J)^-1)), J by finite differences; 4 000 residuals know the noise to 1 %."""
    law, noise, points = LAWS[30], 0.01, np.repeat(OMEGA, 400)
    random = np.random.default_rng(3)
    scatter = noise * (random.standard_normal(points.size) + 1j * random.standard_normal(points.size))
    fit = fit_burgers(points, law.complex_modulus(points) * np.exp(scatter))

    def log_modulus(logs):
        value = np.log(Burgers(*np.exp(logs)).complex_modulus(points))
        return np.concatenate([value.real, value.imag])

    logs, step = np.log(astuple(law)), 1e-5
    jacobian = np.column_stack(
        [(log_modulus(logs + d) - log_modulus(logs - d)) / (2 * step) for d in step * np.eye(4)]
    )
    expected = noise * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    for name, value, relative in zip(NAMES, astuple(law), expected, strict=True):
        assert fit.std_error[name] == pytest.approx(relative * value, rel=0.05)
        assert getattr(fit.law, name) == pytest.approx(value, abs=4 * relative * value)
    assert fit.rms_log_residual == pytest.approx(noise * np.sqrt(2), rel=0.03)


def test_an_interval_is_student_s_on_the_logarithm():
    """Five frequencies are ten residuals and leave six; t is 2.4469 at 95 % and 1.4398 at 80 %."""
    fit = fit_burgers(OMEGA, LAWS[30].complex_modulus(OMEGA) * np.exp(1e-2j * np.array([1, -1, 0, 1, -1])))
    value, error = fit.law.modulus_m, fit.std_error["modulus_m"]
    for level, t in ((0.95, 2.44691), (0.80, 1.43976)):
        low, high = fit.interval("modulus_m", level)
        assert np.log([low / value, high / value]) == pytest.approx(
            np.array([-t, t]) * error / value, rel=1e-5
        )


def test_a_parameter_known_no_better_than_a_third_of_itself_is_undetermined():
    fit = fit_burgers(OMEGA, LAWS[30].complex_modulus(OMEGA))
    values = dict(zip(NAMES, astuple(fit.law), strict=True))
    shares = {"modulus_m": 0.34, "viscosity_m": 0.36, "modulus_k": 0.01, "viscosity_k": 3.0}
    known = replace(fit, std_error={name: share * values[name] for name, share in shares.items()})
    assert known.undetermined == ("viscosity_m", "viscosity_k")
    assert replace(known, unseen=("modulus_k",)).undetermined == NAMES[1:]


@pytest.mark.parametrize("lowest", [-2.0, 2.0])
def test_the_lowest_of_several_minima_is_found(lowest):
    """(x^2 - 4)^2 + (x - lowest)^2 / 10 has a minimum near -2 and one near 2; one start sees one."""
    solution = best_of_starts(
        lambda x: np.array([x[0] ** 2 - 4, (x[0] - lowest) / np.sqrt(10)]),
        bounds=(np.array([-5.0]), np.array([5.0])),
        starts=(np.array([-4.0]), np.array([4.0])),
    )
    assert solution.x[0] == pytest.approx(lowest, abs=1e-6)


def test_standard_errors_are_withheld_where_the_points_cannot_give_them():
    two = OMEGA[[0, 4]]
    assert fit_burgers(two, LAWS[30].complex_modulus(two)).std_error is None
    maxwell = 1 / (1 / 10e9 + 1 / (1j * OMEGA * 1e9))  # no Kelvin element to be seen
    fit = fit_burgers(OMEGA, maxwell * np.exp(1e-3j * np.array([1, -1, 0, 1, -1])))
    assert fit.std_error is None
    np.testing.assert_allclose(fit.law.complex_modulus(OMEGA), maxwell, rtol=3e-3)


@pytest.mark.parametrize(
    ("omega", "modulus", "words"),
    [
        ([], [], "no points"),
        (OMEGA, [1e9], "one modulus each"),
        ([10.0, 10.0], [1e9, 1e9], "at least two frequencies"),
        ([-1.0, 10.0], [1e9, 1e9], "not positive"),
        ([1.0, 10.0], [1e9, np.nan], "zero or not finite"),
        ([1.0, 10.0], [1e9, 0.0], "zero or not finite"),
    ],
)
def test_points_that_cannot_be_fitted_are_refused(omega, modulus, words):
    with pytest.raises(InputError, match=words):
        fit_burgers(omega, modulus)
