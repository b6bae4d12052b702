"""The truth laws are physical, in the range of real mixes, and move along their shift."""

import numpy as np
import pytest
from drawn.laws import KELVIN, SHAPES, Law, draw_law

OMEGA = 2.0 * np.pi * np.logspace(-6, 6, 400)


@pytest.mark.parametrize("shape", SHAPES)
def test_every_shape_is_a_mix_in_the_tested_range(shape):
    temperature, frequency = np.meshgrid([-10, 0, 10, 15, 20, 30], [3, 6, 10, 25, 40])
    for seed in range(5):
        law = draw_law(np.random.default_rng(seed), shape)
        modulus = law.modulus(2.0 * np.pi * frequency, temperature)
        phase = np.degrees(np.angle(modulus))
        assert 0.7e9 < np.abs(modulus).min() < 4e9 and 18e9 < np.abs(modulus).max() < 40e9
        assert 1.5 < phase.min() < 9.0 and 28.0 < phase.max() < 55.0


@pytest.mark.parametrize("shape", SHAPES)
def test_storage_rises_with_frequency_and_loss_follows_its_slope(shape):
    """E2 ~ pi/2 dE1/dln(omega) for a broad spectrum (Booij & Thoone 1982)."""
    modulus = draw_law(np.random.default_rng(1), shape).modulus(OMEGA, 15.0)
    slope = np.gradient(modulus.real, np.log(OMEGA))
    assert np.all(slope > 0) and np.all(modulus.imag > 0)
    tested = np.abs(np.log(OMEGA / (2.0 * np.pi * 11.0))) < np.log(40.0 / 11.0)
    assert modulus.imag[tested] == pytest.approx(0.5 * np.pi * slope[tested], rel=0.1)


def test_limits_of_a_law_are_its_glassy_and_static_modulus():
    parameters = {"glassy": 36e9, "static": 40e6, "log10_tau": -1.4, "k": 0.2, "h": 0.6, "delta": 2.2}
    law = Law("huet_sayegh", parameters, "wlf", {"c1": 15.0, "c2": 130.0})
    ends = law.modulus([1e-40, 1e60], 15.0)
    assert abs(ends[0]) == pytest.approx(40e6, rel=1e-6) and abs(ends[1]) == pytest.approx(36e9, rel=1e-6)


def test_shifts_have_the_stated_rates():
    wlf = Law("huet_sayegh", {}, "wlf", {"c1": 15.0, "c2": 130.0})
    assert wlf.log_shift(25.0) == pytest.approx(-np.log(10.0) * 15.0 * 10.0 / 140.0)
    arrhenius = Law("huet_sayegh", {}, "arrhenius", {"energy": 200e3})
    colder = 1 / (KELVIN - 10.0) - 1 / (KELVIN + 15.0)
    assert arrhenius.log_shift(-10.0) == pytest.approx(200e3 / 8.314462618 * colder)
    straight = {"slope": 0.12}
    assert Law("huet_sayegh", {}, "straight", straight).log_shift(5.0) == pytest.approx(1.2 * np.log(10.0))
    quadratic = Law("huet_sayegh", {}, "quadratic", straight | {"bend": 1.0 / 130.0})
    assert quadratic.log_shift(25.0) == pytest.approx(-1.2 * (1.0 - 10.0 / 130.0) * np.log(10.0))
