"""Sigmoid and CAM: |E*| as published, the phase that causality requires, and fits with their covariance."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.laws_of_modulus import CAM, LawOfModulus, Sigmoid
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum import LAWS, parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, fit_content, uncertainty_of

SHIFT = WLF(20.0, 140.0, 15.0)
SIGMOID = Sigmoid(80e6, 25e9, tau=0.3, gamma=0.25, shift=SHIFT)
CAM_LAW = CAM(100e6, 30e9, tau=0.2, v=0.2, w=0.8, shift=SHIFT)
OMEGA, TEMPERATURE = (
    grid.ravel() for grid in np.meshgrid(2 * np.pi * np.array([0.1, 1.0, 5, 25]), [-10.0, 5.0, 20.0, 35.0])
)


@dataclass(frozen=True)
class Another(LawOfModulus):
    """|E*| of a 2S2P1D law, whose own phase is known: it is causal."""

    title: ClassVar[str] = "other"
    law: TwoS2P1D = TwoS2P1D(30e6, 36e9, 0.2, 0.58, 2.2, 1.0, 250.0, SHIFT)

    def log_modulus(self, log_reduced):
        return np.log(np.abs(self.law.complex_modulus(np.exp(log_reduced), 15.0)))

    def log_slope(self, log_reduced):
        return (self.log_modulus(log_reduced + 1e-4) - self.log_modulus(log_reduced - 1e-4)) / 2e-4


def test_the_phase_is_the_one_of_a_causal_law():
    other = Another(1.0, 2.0, 1.0, SHIFT)
    omega = np.geomspace(1e-3, 1e3, 7)
    exact = other.law.complex_modulus(omega, 15.0)
    assert np.abs(np.log(other.complex_modulus(omega, 15.0) / exact)).max() < 1e-6
    # Booij and Thoone's 90 deg times the slope is off by most of a degree there
    local = 0.5 * np.pi * other.log_slope(np.log(omega))
    assert np.degrees(np.abs(local - np.angle(exact))).max() > 0.5


def test_the_sigmoid_is_that_of_the_standard():
    """log10|E*| = delta + alpha / (1 + exp(beta + gamma log10 t_r)), t_r = 1 / (f a_T)."""
    delta, alpha = np.log10(80e6), np.log10(25e9 / 80e6)
    gamma = 0.25 * np.log(10.0)
    beta = -0.25 * np.log(2 * np.pi * 0.3)
    log_time = -np.log10(OMEGA / (2 * np.pi) * SHIFT.factor(TEMPERATURE))
    expected = delta + alpha / (1 + np.exp(beta + gamma * log_time))
    found = np.log10(np.abs(SIGMOID.complex_modulus(OMEGA, TEMPERATURE)))
    assert found == pytest.approx(expected, abs=1e-12)


def test_the_cam_law_is_as_published():
    reduced = OMEGA * 0.2 * SHIFT.factor(TEMPERATURE)
    expected = 100e6 + (30e9 - 100e6) / (1 + reduced**-0.2) ** (0.8 / 0.2)
    assert np.abs(CAM_LAW.complex_modulus(OMEGA, TEMPERATURE)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", [SIGMOID, CAM_LAW])
def test_the_slope_is_that_of_the_modulus(law):
    x = np.linspace(-30.0, 20.0, 11)
    slope = (law.log_modulus(x + 1e-5) - law.log_modulus(x - 1e-5)) / 2e-5
    assert law.log_slope(x) == pytest.approx(slope, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("law", [SIGMOID, CAM_LAW])
def test_slopes_are_those_of_the_law(law):
    slopes = law.log_slopes(OMEGA, TEMPERATURE)
    for column, name in enumerate(parameters(law)):
        part = law if hasattr(law, name) else law.shift
        ends = []
        for sign in (1, -1):
            moved = replace(part, **{name: getattr(part, name) * np.exp(sign * 1e-4)})
            ends.append(
                (moved if part is law else replace(law, shift=moved)).complex_modulus(OMEGA, TEMPERATURE)
            )
        assert np.abs(slopes[:, column] - np.log(ends[0] / ends[1]) / 2e-4).max() < 1e-6


@pytest.mark.parametrize("law", [SIGMOID, CAM_LAW])
def test_a_fit_finds_its_own_law(law):
    name = next(name for name, kind in LAWS.items() if isinstance(law, kind))
    fit = fit_spectrum(OMEGA, TEMPERATURE, law.complex_modulus(OMEGA, TEMPERATURE), 15.0, Form(name))
    assert parameters(fit.law) == pytest.approx(parameters(law), rel=1e-4)


def test_the_covariance_is_the_scatter_of_fits_to_tests_with_a_common_error():
    """Whole specimens 5 % off beside 1 % of single tests, fitted again and again."""
    law = TwoS2P1D(100e6, 30e9, 0.2, 0.58, 2.2, 0.06, 100.0, SHIFT)
    random, prior = np.random.default_rng(2), prior_of("2s2p1d")
    points = OMEGA.size
    given = np.zeros((2 * points, 2 * points))
    given[:points, :points] = 0.05**2
    given += np.diag(np.full(2 * points, 0.01**2))
    root, true = np.linalg.cholesky(given), law.complex_modulus(OMEGA, TEMPERATURE)
    drawn, first = [], None
    for _ in range(25):
        off = root @ random.standard_normal(2 * points)
        fit = fit_spectrum(
            OMEGA, TEMPERATURE, true * np.exp(off[:points] + 1j * off[points:]), 15.0, prior=prior
        )
        first = fit if first is None else first
        drawn.append(np.log(np.abs(fit.law.complex_modulus(OMEGA, TEMPERATURE))))
    size = np.std(drawn, axis=0, ddof=1)

    def told(covariance):
        half = Uncertainty(covariance, (np.inf, np.inf)).half(first.law, OMEGA, TEMPERATURE)
        return half.real / 1.96

    under = first.restate(given)
    assert 0.7 < np.mean(size / told(under.covariance)) < 1.4  # 25 draws: 14 %
    assert np.mean(size / told(first.covariance)) > 2.0  # all tests taken as independent
    assert under.std_error["glassy_modulus"] > 2.0 * first.std_error["glassy_modulus"]
    # under the scatter that the fit assumed, its own covariance
    own = first.restate(np.eye(2 * points) * found_scatter(first) ** 2)
    assert own.covariance == pytest.approx(first.covariance, rel=1e-6, abs=1e-12)


def found_scatter(fit):
    """The scatter under which the fit's own covariance is that of its response."""
    own = fit.response @ fit.response.T
    return float(np.sqrt((fit.covariance - fit.of_prior)[3, 3] / own[3, 3]))


def test_a_law_file_gives_its_covariance_back():
    fit = fit_spectrum(
        OMEGA,
        TEMPERATURE,
        CAM_LAW.complex_modulus(OMEGA, TEMPERATURE) * 1.001,
        15.0,
        Form("cam"),
        prior=prior_of("cam"),
    )
    content = fit_content(fit, "fitted", Uncertainty(fit.covariance, (10.0, np.inf), (0.01, 0.002)))
    back = uncertainty_of("law.json", content, fit.law)
    assert back.covariance == pytest.approx(fit.covariance) and back.freedom == (10.0, np.inf)
    assert back.form == (0.01, 0.002) and back.tested == (-np.inf, np.inf)
    said = content["covariance_of_logarithms"]
    assert uncertainty_of("law.json", {}, fit.law) is None
    for wrong in (
        {"values": np.eye(2).tolist()},
        {"parameters": said["parameters"][::-1]},
        {"freedom": [10.0]},
        {"tested_C": [0.0]},
        {"values": (np.array(said["values"]) * np.nan).tolist()},
    ):
        with pytest.raises(InputError, match="law.json: key 'covariance_of_logarithms' is damaged"):
            uncertainty_of("law.json", {"covariance_of_logarithms": said | wrong}, fit.law)
    low, high = content["interval_95"]["E_glassy_Pa"]
    by = np.exp(2.2281 * np.sqrt(fit.covariance[1, 1]))  # Student's t of ten
    assert (low, high) == pytest.approx((content["E_glassy_Pa"] / by, content["E_glassy_Pa"] * by), rel=1e-4)
