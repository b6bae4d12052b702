"""2S2P1D with WLF: its limits, and time-temperature superposition."""

import pytest

from asphalt_nscd.rheology.spectrum import TwoS2P1D

LAW = TwoS2P1D(100e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, 11.7, 79.9, 15.0)


def test_limits():
    assert LAW.complex_modulus(1e60, 15.0) == pytest.approx(42e9, rel=1e-5)
    assert LAW.complex_modulus(1e-30, 15.0) == pytest.approx(100e6, rel=1e-6)


def test_law_written_out():
    omega = 10.0
    x = 1j * omega * 0.14
    expected = 100e6 + (42e9 - 100e6) / (1 + 1.64 * x**-0.2 + x**-0.6 + 1 / (x * 28.0))
    assert LAW.complex_modulus(omega, 15.0) == pytest.approx(expected, rel=1e-13)


def test_temperature_acts_as_a_change_of_frequency():
    decades = -11.7 * (30 - 15) / (79.9 + 30 - 15)
    assert LAW.shift_factor(15.0) == 1.0
    assert LAW.shift_factor(30.0) == pytest.approx(10**decades, rel=1e-12)
    assert LAW.complex_modulus(100.0, 30.0) == pytest.approx(
        LAW.complex_modulus(100.0 * 10**decades, 15.0), rel=1e-12
    )
    assert abs(LAW.complex_modulus(100.0, 30.0)) < abs(LAW.complex_modulus(100.0, 15.0))
