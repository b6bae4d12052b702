"""A bond law with a memory of its own is one class: Maxwell elements side by side, which remember their stresses.

Two of them are a Burgers chain, so that every stepper must show what it shows of that, to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.law import AnyLaw, BondLaw, LawStep
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
from asphalt_nscd.nscd.stepping.integrator import March
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme


@dataclass(frozen=True)
class SideBySide(AnyLaw):
    """sigma = sum sigma_i with sigma_i' = -E_i U - sigma_i / tau_i; remembers sigma_i [Pa]."""

    springs: np.ndarray  # E_i, Pa
    times: np.ndarray  # tau_i, s

    @property
    def memory(self):
        return self.springs.size

    def step(self, dt):
        left = 1.0 / (1.0 + dt / self.times)
        return SideBySideStep(dt, 1.0 / (dt * self.springs * left).sum(), left, dt * self.springs * left)

    def discrete_modulus(self, omega, dt):
        rate = (1.0 - np.exp(-1j * omega * dt)) / dt if dt else 1j * omega
        return complex((self.springs * rate / (rate + 1.0 / self.times)).sum())

    def stored(self, strain, one, other):
        return sum(strain(a / e, b) for e, a, b in zip(self.springs, one[1], other[1]))

    def dissipated(self, strain, sigma, memory, rate):
        return sum(strain(a / (e * t), a) for e, t, a in zip(self.springs, self.times, memory))


@dataclass(frozen=True)
class SideBySideStep(LawStep):
    dt: float
    compliance: float
    left: np.ndarray
    gain: np.ndarray

    def explicit_part(self, sigma, memory):
        return self.compliance * np.tensordot(self.left, memory, 1)

    def remembered(self, sigma, velocity, memory):
        along = (slice(None), *[None] * (memory.ndim - 1))
        return self.left[along] * memory - self.gain[along] * velocity


LAW = SideBySide(np.array([8e9, 3e9]), np.array([2e-3, 0.05]))
DT = 5e-4


def burgers():
    """The same law in series: what is left of 1/E beside spring and dashpot is one Kelvin element."""
    spring, dashpot = LAW.springs.sum(), (LAW.springs * LAW.times).sum()
    rates = np.array([10.0, 1000.0])
    moduli = np.array([(LAW.springs * s / (s + 1.0 / LAW.times)).sum() for s in rates])
    low, high = 1.0 / (1.0 / moduli - 1.0 / spring - 1.0 / dashpot / rates)
    viscosity = (high - low) / (rates[1] - rates[0])
    return BondLaw(spring, dashpot, np.array([low - viscosity * rates[0]]), np.array([viscosity]))


def run(system, law, method, scheme):
    """Forces of a head that goes and turns, bonds broken, and the stress and energies at the end."""
    state = CondensedState.rest_state(system, law)
    if method == "reduced":
        stepper = ReducedStepper(ReducedModel(system, ritz_basis(system, 6)), law, DT / scheme.a, 1e-8)
    else:
        stepper = CondensedStepper(system, law, DT / scheme.a, state)
    march = March(stepper, scheme, law, DT)
    force = np.array([march.move_to(4e-6 * np.sin(0.1 * n)) for n in range(1, 60)])
    return force, stepper.state.broken, march.account.sums


@pytest.mark.parametrize("scheme", [Scheme(), Scheme.named("fitted", 0.1)], ids=["euler", "fitted"])
@pytest.mark.parametrize("method", ["condensed", "reduced"])
def test_every_stepper_shows_the_law(beam_system, method, scheme):
    weak = replace(beam_system, strength=np.full_like(beam_system.strength, 0.2))
    force, broken, energies = run(weak, LAW, method, scheme)
    expected, also_broken, _ = run(weak, burgers(), method, scheme)
    assert broken == also_broken and broken
    np.testing.assert_allclose(force, expected, rtol=0, atol=1e-7 * np.abs(expected).max())
    assert abs(energies.error) < 1e-10 * energies.actuator
    assert min(energies.dashpots, energies.springs, energies.fracture) > 0.0


def test_sweeps_show_the_law(beam_system):
    forces = []
    for law in (LAW, burgers()):
        state = CondensedState.rest_state(beam_system, law)
        stepper = SweepingStepper(beam_system, law, DT, state, 0.0, 4)
        forces.append([stepper.advance(v) for v in (1e-4, 2e-4, -1e-4, 0.0)])
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-6)


def test_the_modulus_of_the_scheme_is_that_of_the_chain():
    for dt in (0.0, DT):
        assert LAW.discrete_modulus(60.0, dt) == pytest.approx(
            burgers().discrete_modulus(60.0, dt), rel=1e-12
        )


def test_a_march_begins_where_its_actuator_stands(beam_system):
    """What is held at 3 um from the start is not pulled there."""
    first, still = (
        March(
            CondensedStepper(beam_system, LAW, DT, CondensedState.rest_state(beam_system, LAW)),
            Scheme(),
            LAW,
            DT,
            at,
        ).move_to(at)
        for at in (3e-6, 0.0)
    )
    assert first == pytest.approx(still, abs=1e-9)
