"""Continuous laws and their shifts as they are written, and their slopes."""

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, Arrhenius
from asphalt_nscd.rheology.spectrum import parameters

SHIFT = WLF(11.7, 79.9, 15.0)
LAW = TwoS2P1D(100e6, 42e9, 0.2, 0.6, 1.64, 0.14, 28.0, SHIFT)
HUET = HuetSayegh(100e6, 42e9, 0.2, 0.6, 1.64, 0.14, SHIFT)


def test_laws_written_out():
    """At 30 degC a frequency acts as one a_T times lower."""
    omega, temperature = np.array([1e-9, 10.0, 1e4]), 30.0
    x = 1j * omega * SHIFT.factor(30.0) * 0.14
    expected = 100e6 + (42e9 - 100e6) / (1 + 1.64 * x**-0.2 + x**-0.6)
    assert HUET.complex_modulus(omega, temperature) == pytest.approx(expected, rel=1e-13)
    expected = 100e6 + (42e9 - 100e6) / (1 + 1.64 * x**-0.2 + x**-0.6 + 1 / (x * 28.0))
    assert LAW.complex_modulus(omega, temperature) == pytest.approx(expected, rel=1e-13)


def test_shifts_written_out():
    assert SHIFT.factor(30.0) == pytest.approx(10 ** (-11.7 * 15 / (79.9 + 15)), rel=1e-12)
    # 200 kJ/mol between 15 and 30 degC, in absolute temperatures
    exponent = 2e5 / 8.314462618 * (1 / 303.15 - 1 / 288.15)
    assert Arrhenius(2e5, 15.0).factor(30.0) == pytest.approx(np.exp(exponent), rel=1e-12)


def test_wlf_ends_at_its_pole():
    SHIFT.factor([-60.0, 15.0])
    with pytest.raises(InputError, match="79.9 K below 15 degC"):
        SHIFT.factor([-65.0, 15.0])
    with pytest.raises(InputError, match="64 K below 0 degC"):
        WLF(11.7, 64.0, 0.0).factor(-64.0)  # the pole itself


def test_parameters_by_name():
    assert parameters(LAW) == {
        "static_modulus": 100e6, "glassy_modulus": 42e9, "k": 0.2, "h": 0.6, "delta": 1.64, "tau": 0.14,
        "beta": 28.0, "c1": 11.7, "c2": 79.9,
    }  # fmt: skip


@pytest.mark.parametrize("law", [LAW, HUET])
@pytest.mark.parametrize("shift", [SHIFT, Arrhenius(2e5, 15.0)])
def test_slopes_are_those_of_finite_differences(law, shift):
    law = replace(law, shift=shift)
    omega, temperature = (x.ravel() for x in np.meshgrid([0.6, 60.0, 250.0], [-10.0, 15.0, 40.0]))
    slopes, step = law.log_slopes(omega, temperature), 1e-5
    assert slopes.shape == (omega.size, len(parameters(law)))

    def logarithm(name, factor):
        part = law if hasattr(law, name) else law.shift
        moved = replace(part, **{name: factor * getattr(part, name)})
        moved = moved if part is law else replace(law, shift=moved)
        return np.log(moved.complex_modulus(omega, temperature))

    for column, name in enumerate(parameters(law)):
        expected = (logarithm(name, np.exp(step)) - logarithm(name, np.exp(-step))) / (2.0 * step)
        assert np.abs(expected).max() > 1e-4
        assert slopes[:, column] == pytest.approx(expected, rel=1e-6, abs=1e-9)
