"""Kelvin chains made from other laws: as close as they say, with as few elements as that takes."""

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

MIX = TwoS2P1D(80e6, 42.6e9, 0.2, 0.6, 1.64, 0.14, 28.0, WLF(11.7, 79.9, 15.0))
LOW, HIGH = 2 * np.pi * 3.0, 2 * np.pi * 40.0


def at(temperature):
    return lambda omega: MIX.complex_modulus(omega, temperature)


def largest_error(chain, modulus, low, high):
    """On a grid of other frequencies than the conversion's."""
    omega = np.geomspace(low, high, 1237)
    return np.abs(np.log(chain.complex_modulus(omega) / modulus(omega))).max()


@pytest.mark.parametrize(("low", "high"), [(LOW, HIGH), (1e-2 * LOW, 1e2 * HIGH)])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("temperature", [-10.0, 15.0, 30.0, 50.0])
def test_the_stated_error_holds(temperature, tolerance, low, high):
    chain, error = kelvin_chain(at(temperature), low, high, tolerance)
    assert error <= tolerance
    assert largest_error(chain, at(temperature), low, high) == pytest.approx(error, rel=0.05)


def test_elements_are_few():
    """At most five for the paper's band to 1e-3; more only for more accuracy or a wider band."""
    number = [len(kelvin_chain(at(15.0), LOW, HIGH, 10.0**-n)[0].kelvin_springs) for n in (1, 2, 3, 4)]
    assert number == sorted(number) and number[0] < number[2] <= 5 < number[3] <= 8
    assert number[2] < len(kelvin_chain(at(15.0), 0.01 * LOW, HIGH, 1e-3)[0].kelvin_springs) <= 10


def test_retardation_times_reach_no_further_than_ten_times_beyond_the_band():
    low = 1e-4 * LOW
    chain, _ = kelvin_chain(at(15.0), low, HIGH, 1e-4)
    times = np.divide(chain.kelvin_dashpots, chain.kelvin_springs)
    assert 0.1 / HIGH < times.min() and times.max() < 10.0 / low


def test_a_chain_comes_back():
    """A spring, a dashpot, one element where the conversion puts it first."""
    given = KelvinChain(24.3e9, 3.71e9, (48.4e9,), (48.4e9 / np.sqrt(LOW * HIGH),))
    chain, error = kelvin_chain(given.complex_modulus, LOW, HIGH, 1e-9)
    assert error < 1e-9
    found = np.concatenate([[chain.spring, chain.dashpot], chain.kelvin_springs, chain.kelvin_dashpots])
    expected = [given.spring, given.dashpot, *given.kelvin_springs, *given.kelvin_dashpots]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_a_solid_gets_no_dashpot():
    solid = KelvinChain(30e9, np.inf, (10e9,), (1e8,))
    assert kelvin_chain(solid.complex_modulus, 1.0, 1e4)[0].dashpot > 1e3 * 10e9


def test_one_frequency_is_a_band():
    chain, error = kelvin_chain(at(15.0), 60.0, 60.0)
    assert error < 1e-12
    assert chain.complex_modulus(60.0) == pytest.approx(MIX.complex_modulus(60.0, 15.0), rel=1e-12)


def test_what_no_chain_follows_is_refused():
    with pytest.raises(InputError, match="no Kelvin chain of 60 elements or fewer follows the law to 0.001"):
        kelvin_chain(lambda omega: 1e9 * np.exp(0.3j * np.log(omega)), LOW, HIGH)  # phase above 90 degrees
    with pytest.raises(InputError, match="band from 2 to 1 rad/s"):
        kelvin_chain(at(15.0), 2.0, 1.0)
