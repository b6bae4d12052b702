"""The phase that |E*| requires, against laws whose phase is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from asphalt_nscd.diagnosis.screening.kramers_kronig import WEIGHTS, covariances, required_phase
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

SHIFT = WLF(24.0, 160.0, 15.0)
FREQUENCY = np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0])
LAWS = {
    "2S2P1D": TwoS2P1D(86e6, 26e9, k=0.22, h=0.65, delta=2.5, tau=0.8, beta=43.0, shift=SHIFT),
    "Huet-Sayegh": HuetSayegh(200e6, 30e9, k=0.18, h=0.5, delta=2.0, tau=0.5, shift=SHIFT),
}


def response(law, temperature):
    return law.complex_modulus(2.0 * np.pi * FREQUENCY, temperature)


def havriliak_negami(temperature):
    shifted = 2j * np.pi * FREQUENCY * SHIFT.factor(temperature)
    return 30e6 + 33e9 * (1.0 - 1.0 / (1.0 + shifted**0.5) ** 0.5)


def first_order(log_modulus):
    cubic = np.polynomial.Polynomial.fit(np.log(FREQUENCY), log_modulus, 3)
    return 0.5 * np.pi * cubic.deriv()(np.log(FREQUENCY))


@pytest.mark.parametrize("exponent", [0.1, 0.5, 0.9])
def test_power_law_has_a_constant_phase(exponent):
    found = required_phase(FREQUENCY, exponent * np.log(FREQUENCY))
    assert found.phase == pytest.approx(exponent * np.pi / 2.0, abs=np.radians(0.7))
    assert found.phase[1:-1] == pytest.approx(exponent * np.pi / 2.0, abs=np.radians(0.2))


@pytest.mark.parametrize("temperature", [-10.0, 4.0, 15.0, 21.0, 37.0])
@pytest.mark.parametrize("law", ["2S2P1D", "Huet-Sayegh", "Havriliak-Negami"])
def test_phase_of_a_law_is_found_from_its_modulus_within_the_stated_error(law, temperature):
    modulus = havriliak_negami(temperature) if law == "Havriliak-Negami" else response(LAWS[law], temperature)
    found = required_phase(FREQUENCY, np.log(np.abs(modulus)))
    off = np.degrees(found.phase - np.angle(modulus))
    assert np.abs(off / np.degrees(found.std_error)).max() < 4.0
    assert np.abs(off[1:-1]).max() < 0.7  # the ends know less
    assert np.degrees(found.std_error[1:-1]).max() < 1.0


def test_relation_beats_the_slope_where_the_slope_bends():
    ours, slope = [], []
    for temperature in np.arange(-20.0, 61.0, 5.0):
        modulus = response(LAWS["2S2P1D"], temperature)
        logarithm, phase = np.log(np.abs(modulus)), np.angle(modulus)
        ours.append(required_phase(FREQUENCY, logarithm).phase - phase)
        slope.append(first_order(logarithm) - phase)
    assert np.sqrt(np.mean(np.square(ours))) < 0.6 * np.sqrt(np.mean(np.square(slope)))


def test_scale_of_the_modulus_changes_no_phase():
    logarithm = np.log(np.abs(response(LAWS["2S2P1D"], 15.0)))
    assert required_phase(FREQUENCY, logarithm + 5.0).phase == pytest.approx(
        required_phase(FREQUENCY, logarithm).phase, abs=1e-9
    )


def test_covariances_are_those_of_modulus_and_phase():
    for covariance in covariances(FREQUENCY):
        assert covariance == pytest.approx(covariance.T)
        assert np.linalg.eigvalsh(covariance).min() > -1e-9
        # A rising slope raises phase and the modulus above the middle of the band together.
        assert covariance[5, 11] > 0.0 > covariance[0, 6]


def test_standard_error_is_the_width_of_the_mixture():
    """Density of the phase given the moduli, of all ripples with their weights, on a grid."""
    f = np.array([0.1, 0.3, 1.0, 3.0, 10.0, 30.0])
    bent = np.array([0.0, 0.3, 0.62, 0.75, 1.1, 1.4])  # on which no ripple has most of the weight
    for values in (bent, 0.3 * np.log(f)):
        found = required_phase(f, values, scatter=0.02)
        centred = values - values.mean()
        for test in range(f.size):
            phase = np.linspace(-2.0, 4.0, 6001)
            density = np.zeros(phase.size)
            for covariance, weight in zip(covariances(f), WEIGHTS):
                kept = [*range(f.size), f.size + test]
                whole = covariance[np.ix_(kept, kept)] + np.diag([0.02**2] * f.size + [0.0])
                points = np.column_stack([np.tile(centred, (phase.size, 1)), phase])
                density += weight * multivariate_normal(cov=whole).pdf(points)
            density /= density.sum()
            mean = density @ phase
            assert found.phase[test] == pytest.approx(mean, abs=1e-4)
            assert found.std_error[test] == pytest.approx(np.sqrt(density @ (phase - mean) ** 2), rel=1e-3)
