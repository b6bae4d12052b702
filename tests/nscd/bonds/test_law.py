"""A step of the bond law: the balance of its elements, and its modulus in steady oscillation."""

import numpy as np
import pytest
from theory.test_law import BURGERS, CHAIN, FREQUENCY, LAW, steady_modulus

from asphalt_nscd.nscd.bonds.law import BondLaws


def chain_modulus(omega):
    s = 1j * omega
    return 1 / (1 / 24.3e9 + 1 / (s * 3.71e9) + 1 / (48.4e9 + s * 0.773e9) + 1 / (90e9 + s * 0.18e9))


@pytest.mark.parametrize("law", [LAW, CHAIN])
@pytest.mark.parametrize("steps", [20, 500])
def test_discrete_modulus_is_the_steady_state_of_the_scheme(law, steps):
    """To 1e-9, what is left of the transient; the scheme's own deviation from the law is 1e-2 to 1e-4."""
    omega, dt = 2 * np.pi * FREQUENCY, 1 / (FREQUENCY * steps)
    stepped = steady_modulus(law, steps, cycles=60)
    assert stepped == pytest.approx(law.discrete_modulus(omega, dt), rel=1e-9)
    assert abs(stepped / law.discrete_modulus(omega, 0.0) - 1) > 1e-4


@pytest.mark.parametrize(("law", "exact"), [(LAW, BURGERS.complex_modulus), (CHAIN, chain_modulus)])
@pytest.mark.parametrize("omega", [0.5, 60.0, 2e4])
def test_discrete_modulus_without_a_step_is_the_exact_law(law, exact, omega):
    assert law.discrete_modulus(omega, 0.0) == pytest.approx(exact(omega), rel=1e-14)
    assert law.discrete_modulus(omega, 1e-9) == pytest.approx(exact(omega), rel=1e-4)


@pytest.mark.parametrize("law", [LAW, CHAIN])
def test_balance_of_the_elements(law):
    """One step from an arbitrary state: every element carries sigma+, their rates add up to U+.

    Rounding only, amplified by differences over dt: 1e-12 of the largest term.
    """
    rng = np.random.default_rng(7)
    dt = 3e-4
    elements = law.kelvin_springs.size
    sigma, kelvin = rng.normal(0, 1e6, 50), rng.normal(0, 1e-5, (elements, 50))
    velocity = rng.normal(0, 1e-2, 50)
    step = law.step(dt)
    new_sigma, new_kelvin = step.update(step.explicit_part(sigma, kelvin), velocity, kelvin)

    kelvin_rate = (new_kelvin - kelvin) / dt
    spring_rate = -(new_sigma - sigma) / law.spring / dt
    dashpot_rate = -new_sigma / law.dashpot
    scale = max(np.abs(x).max() for x in (kelvin_rate, spring_rate, dashpot_rate, velocity))
    total = spring_rate + dashpot_rate + kelvin_rate.sum(axis=0)
    np.testing.assert_allclose(total, velocity, rtol=0, atol=1e-12 * scale)
    for j in range(elements):
        carried = -law.kelvin_springs[j] * new_kelvin[j] - law.kelvin_dashpots[j] * kelvin_rate[j]
        np.testing.assert_allclose(carried, new_sigma, rtol=0, atol=1e-12 * np.abs(carried).max())


def test_update_keeps_the_shape_of_a_network():
    """sigma of any shape, Kelvin displacements with one axis more: the same numbers as one by one."""
    rng = np.random.default_rng(8)
    step = CHAIN.step(1e-4)
    sigma, velocity, kelvin = rng.normal(size=(4, 3)), rng.normal(size=(4, 3)), rng.normal(size=(2, 4, 3))
    explicit = step.explicit_part(sigma, kelvin)
    new_sigma, new_kelvin = step.update(explicit, velocity, kelvin)
    assert new_sigma.shape == (4, 3) and new_kelvin.shape == (2, 4, 3)
    for index in np.ndindex(4, 3):
        at = (slice(None), *index)
        b = step.explicit_part(sigma[index], kelvin[at])
        one_sigma, one_kelvin = step.update(b, velocity[index], kelvin[at])
        assert new_sigma[index] == pytest.approx(one_sigma, rel=1e-14)
        np.testing.assert_allclose(new_kelvin[at], one_kelvin, rtol=1e-14)


@pytest.mark.parametrize("law", [LAW, CHAIN, BondLaws.of_bonds((CHAIN,), np.array([0]))])
def test_what_springs_store_and_dashpots_take(law):
    """Bilinear: sigma^2/Em and Ek dk^2, sigma^2/eta_m and eta_k dk'^2, summed with a weight for each bond."""
    one = law.table[0] if isinstance(law, BondLaws) else law
    rng, weight = np.random.default_rng(2), np.array([1.0, 2.0, 4.0])
    sigma, memory = rng.normal(size=(2, 3)), rng.normal(size=(2, law.memory, 3))
    springs, dashpots = one.kelvin_springs[:, None], one.kelvin_dashpots[:, None]

    def strain(a, b):
        return float((weight * a * b).sum())

    stored = (
        weight * (sigma[0] * sigma[1] / one.spring + (springs * memory[0] * memory[1]).sum(axis=0))
    ).sum()
    taken = (weight * (sigma[0] ** 2 / one.dashpot + (dashpots * memory[1] ** 2).sum(axis=0))).sum()
    pair = (sigma[0], memory[0]), (sigma[1], memory[1])
    assert law.stored(strain, *pair) == pytest.approx(stored, rel=1e-12)
    assert law.dissipated(strain, sigma[0], memory[0], memory[1]) == pytest.approx(taken, rel=1e-12)


def test_coefficients_are_those_of_the_equations():
    dt, damped = 1e-3, CHAIN.kelvin_dashpots + 1e-3 * CHAIN.kelvin_springs
    recall, decay, gain, follow = CHAIN.step(dt).coefficients(2)
    np.testing.assert_allclose(
        recall, [1.0 / (dt * CHAIN.spring), *(-CHAIN.kelvin_springs / damped)], rtol=1e-14
    )
    np.testing.assert_allclose(decay, CHAIN.kelvin_dashpots / damped, rtol=1e-14)
    np.testing.assert_allclose(gain, dt / damped, rtol=1e-14)
    assert not follow.any()
