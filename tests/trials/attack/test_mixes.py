"""Truth laws: phases that causality requires, shifts that order isotherms."""

import numpy as np
import pytest
from attack.mixes import LAWS, REFERENCE, SHIFTS, Mix, causal_phase


@pytest.mark.parametrize("law", ["Havriliak-Negami", "bimodal", "Huet-Sayegh"])
def test_bodes_integral_gives_the_phase_that_a_law_has_in_closed_form(law):
    form, ranges = LAWS[law]
    parameters = {name: np.mean(ends) for name, ends in ranges.items()}

    def log_norm(x):
        return form(np.ravel(x), parameters).real.reshape(np.shape(x))

    x = np.linspace(-18.0, 18.0, 13)
    exact = form(x, parameters).imag
    assert np.degrees(np.abs(exact)).max() > 20.0
    np.testing.assert_allclose(causal_phase(log_norm, x), exact, atol=np.radians(2e-3))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("shift", SHIFTS)
def test_a_mix_is_asphalt(law, shift):
    """Glassy and static moduli, phases and the order of isotherms are those of tables in this field."""
    for seed in range(5):
        mix = Mix.draw(law, shift, np.random.default_rng(seed))
        f = np.tile([0.1, 1.0, 10.0, 25.0], 5)
        t = np.repeat([-10.0, 4.0, 20.0, 37.0, 54.0], 4)
        value = mix.log_modulus(f, t)
        norm = np.exp(value.real.reshape(5, 4))
        assert (np.diff(norm, axis=0) < 0.0).all() and (np.diff(norm, axis=1) > 0.0).all()
        assert 5e7 < norm.min() and norm.max() < 4e10 and 5e8 < norm[2, 2] < 3e10
        assert 0.5 < np.degrees(value.imag).min() and np.degrees(value.imag).max() < 60.0


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_warmer_test_is_a_slower_one(shift):
    mix = Mix.draw("Huet-Sayegh", shift, np.random.default_rng(3))
    log_shift = SHIFTS[shift][0](np.array([REFERENCE, 35.0]), mix.constants)
    assert log_shift[0] == pytest.approx(0.0, abs=1e-12) and log_shift[1] < 0.0
    warm = mix.log_modulus(np.array([10.0]), np.array([35.0]))
    slow = mix.log_modulus(np.array([10.0]), np.array([REFERENCE]), slower=log_shift[1])
    assert warm == pytest.approx(slow, abs=1e-12)
