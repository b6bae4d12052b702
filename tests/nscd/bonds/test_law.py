"""The bond law alone against the analytic Burgers law: creep, relaxation, steady oscillation."""

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.rheology.burgers import Burgers

BURGERS = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)  # 15 degC; relaxation times 153 ms and 16 ms
LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))
CHAIN = BondLaw(24.3e9, 3.71e9, np.array([48.4e9, 90e9]), np.array([0.773e9, 0.18e9]))
FREQUENCY = 10.0
DIVISIONS = np.array([1, 2, 4, 8, 16])  # of a first step of 0.5 ms


def chain_creep(time):
    """Spring, dashpot and the two Kelvin elements of CHAIN summed by hand."""
    delayed = (1 - np.exp(-time * 48.4e9 / 0.773e9)) / 48.4e9 + (1 - np.exp(-time * 90e9 / 0.18e9)) / 90e9
    return 1 / 24.3e9 + time / 3.71e9 + delayed


def chain_modulus(omega):
    s = 1j * omega
    return 1 / (1 / 24.3e9 + 1 / (s * 3.71e9) + 1 / (48.4e9 + s * 0.773e9) + 1 / (90e9 + s * 0.18e9))


def creep(law, time, dt):
    """Opening [m] after a unit tension of 1 Pa has acted for `time`."""
    step = law.step(dt)
    sigma, kelvin, opening = np.zeros(1), np.zeros((law.kelvin_springs.size, 1)), np.zeros(1)
    for _ in range(round(time / dt)):
        explicit = step.explicit_part(sigma, kelvin)
        velocity = explicit + step.compliance  # U+ = b - S sigma+ at sigma+ = -1
        opening += dt * velocity
        sigma, kelvin = step.update(explicit, velocity, kelvin)
        np.testing.assert_allclose(sigma, -1.0, rtol=1e-12)
    return opening[0]


def follow(law, opening, dt):
    """Stress (n,) [Pa] at a prescribed history of the opening (n,) [m], from rest."""
    step = law.step(dt)
    sigma, kelvin = np.zeros(1), np.zeros((law.kelvin_springs.size, 1))
    history = np.empty(opening.size)
    for n, velocity in enumerate(np.diff(opening, prepend=0.0) / dt):
        sigma, kelvin = step.update(step.explicit_part(sigma, kelvin), velocity, kelvin)
        history[n] = sigma[0]
    return history


def steady_modulus(law, frequency, steps, cycles=60):
    """-sigma/u of a steady oscillation with `steps` per cycle; 60 cycles leave transients of 1e-10."""
    time = np.arange(1, cycles * steps + 1) / (frequency * steps)
    angle = 2 * np.pi * frequency * time
    sigma = follow(law, np.sin(angle), 1 / (frequency * steps))
    last = slice(-steps, None)
    return -2j * (sigma[last] * np.exp(-1j * angle[last])).mean()


def order_of(errors, steps=DIVISIONS):
    """Slope of the error against the step length on logarithmic axes."""
    return -np.polyfit(np.log(steps), np.log(np.abs(errors)), 1)[0]


@pytest.mark.parametrize(("law", "exact"), [(LAW, BURGERS.creep_compliance), (CHAIN, chain_creep)])
def test_creep_converges_in_first_order(law, exact):
    errors = [creep(law, 0.02, 5e-4 / n) / exact(0.02) - 1 for n in DIVISIONS]
    assert abs(errors[-1]) < 1e-3
    assert order_of(errors) == pytest.approx(1.0, abs=0.05)


def test_relaxation_converges_in_first_order():
    """A sudden opening of 1 m/m calls forth tension, sigma < 0, that decays as E(t)."""
    errors = []
    for n in DIVISIONS:
        dt = 5e-4 / n
        sigma = follow(LAW, np.ones(round(0.02 / dt)), dt)
        assert (sigma < 0).all()
        # the jump happens within the first step: half a step of shift is part of the first-order error
        errors.append(-sigma[-1] / BURGERS.relaxation_modulus(0.02) - 1)
    assert abs(errors[-1]) < 2e-3
    assert order_of(errors) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("law", "exact"), [(LAW, BURGERS.complex_modulus), (CHAIN, chain_modulus)])
def test_oscillation_converges_in_first_order(law, exact):
    modulus = exact(2 * np.pi * FREQUENCY)
    errors = [steady_modulus(law, FREQUENCY, 60 * n, cycles=20) / modulus - 1 for n in DIVISIONS]
    assert abs(errors[-1]) < 2e-3
    assert order_of(errors) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("law", [LAW, CHAIN])
@pytest.mark.parametrize("steps", [20, 500])
def test_discrete_modulus_is_the_steady_state_of_the_scheme(law, steps):
    """To 1e-9, what is left of the transient; the scheme's own deviation from the law is 1e-2 to 1e-4."""
    omega, dt = 2 * np.pi * FREQUENCY, 1 / (FREQUENCY * steps)
    stepped = steady_modulus(law, FREQUENCY, steps)
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
