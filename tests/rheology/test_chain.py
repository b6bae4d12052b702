"""The Kelvin chain: term by term, against Burgers, and what is refused."""

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain

OMEGA = np.array([0.1, 18.85, 251.3])
CHAIN = KelvinChain(24.3e9, 3.71e9, (48.4e9, 90e9), (0.773e9, 0.18e9))


def test_modulus_written_out():
    s = 1j * OMEGA
    expected = 1 / (1 / 24.3e9 + 1 / (s * 3.71e9) + 1 / (48.4e9 + s * 0.773e9) + 1 / (90e9 + s * 0.18e9))
    np.testing.assert_allclose(CHAIN.complex_modulus(OMEGA), expected, rtol=1e-13)
    assert CHAIN.complex_modulus(OMEGA[1]) == pytest.approx(expected[1], rel=1e-13)


def test_burgers_is_a_chain_of_one_element():
    law = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
    np.testing.assert_allclose(
        law.kelvin_form().complex_modulus(OMEGA), law.complex_modulus(OMEGA), rtol=1e-13
    )


def test_parts_may_be_absent():
    solid = KelvinChain(np.inf, np.inf, (10e9,), (1e9,))
    np.testing.assert_allclose(solid.complex_modulus(OMEGA), 10e9 + 1j * OMEGA * 1e9, rtol=1e-13)
    assert KelvinChain(10e9, np.inf, (), ()).complex_modulus(3.0) == pytest.approx(10e9, rel=1e-13)


def test_a_factor_acts_on_every_modulus_alike():
    np.testing.assert_allclose(
        CHAIN.scaled(1.2).complex_modulus(OMEGA), 1.2 * CHAIN.complex_modulus(OMEGA), rtol=1e-13
    )


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ((1e9, 1e9, (1e9,), ()), "1 springs and 0 dashpots"),
        ((-1e9, 1e9, (), ()), "not positive"),
        ((1e9, np.nan, (), ()), "not positive"),
        ((1e9, 1e9, (1e9,), (np.inf,)), "not positive"),
        ((np.inf, np.inf, (), ()), "it is empty"),
    ],
)
def test_impossible_chains_are_refused(values, words):
    with pytest.raises(InputError, match=words):
        KelvinChain(*values)
