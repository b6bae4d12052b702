"""A law for each component of each bond: full stepping and the frequency domain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from naive.stepping import NaiveState, naive_step
from theory.marches import OMEGA, followed, march, stiffness
from theory.specimens import mixed, system_of

from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.law import BondLaw, BondLaws
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper

DT = 2.5e-4  # s
RIG = HeadDevices(1e-7, 1e4, 5.0, 0.2)
STONE = BondLaw(60e9, np.inf, np.array([]), np.array([]))
MAXWELL = BondLaw(30e9, 0.03e9, np.array([]), np.array([]))
BURGERS = BondLaw(24.3e9, 0.06e9, np.array([48.4e9]), np.array([0.077e9]))
SOLID = BondLaw(8e9, np.inf, np.array([3e9, 11e9]), np.array([0.004e9, 0.05e9]))
TABLE = (STONE, MAXWELL, BURGERS, SOLID)


def between(springs=(2e-3, 5e-3), mass=1e-9, series=True, **more):
    """A head and a wall, joined along one line by two bonds: in series over a body, or side by side.

    A third holds the body where it would be loose.
    """
    rows = np.zeros((9, 2))
    rows[[0, 3, 6]] = [[-1, 1], [0, -1], [0, 0]] if series else [[-1, 0], [-1, 0], [0, 1]]
    return system_of(rows, np.repeat([*springs, 1e-3], 3), [1.0, mass], driven=0, **more)


@pytest.mark.parametrize("name", ["euler", "fitted"])
@pytest.mark.parametrize(("amplitude", "narrowing"), [(8e-5, 1.0), (3e-5, 1e-3)])
def test_one_law_in_every_bond_is_the_shared_law(beam_system, quick_law, name, amplitude, narrowing):
    """Through breaks, closing gaps and a rig: the same breaks, and forces and energies to 1e-12."""
    system = replace(beam_system, gap=narrowing * beam_system.gap)
    everywhere = mixed(system, (quick_law, replace(quick_law), replace(quick_law)))
    runs = [march(system, law, DT, name, devices=RIG) for law in (quick_law, everywhere)]
    sine = np.append(np.zeros(10), amplitude * np.sin(2 * np.pi / 100 * np.arange(1, 61)))
    shared, own = (followed(run, sine) for run in runs)
    np.testing.assert_allclose(own, shared, rtol=0, atol=1e-12 * np.abs(shared).max())
    assert (len(runs[0].stepper.state.broken) > 0) == (narrowing == 1.0)
    assert runs[0].stepper.state.broken == runs[1].stepper.state.broken
    shared, own = (vars(run.account.sums) for run in runs)
    assert own == pytest.approx(shared, rel=1e-9, abs=1e-12 * abs(shared["actuator"]))


@pytest.mark.parametrize("series", [True, False])
def test_oscillation_of_two_bonds(series):
    """Two laws in series add their compliances, side by side their moduli: by steps and by frequency, to 1e-8."""
    system, steps = between(series=series), 100
    law, dt = BondLaws.of_bonds((BURGERS, SOLID), np.array([0, 1, 0])), 2 * np.pi / OMEGA / steps
    one, other = 2e-3 * BURGERS.discrete_modulus(OMEGA, dt), 5e-3 * SOLID.discrete_modulus(OMEGA, dt)
    exact = 1 / (1 / one + 1 / other) if series else one + other
    assert driving_force(system, law.discrete_modulus(OMEGA, dt), OMEGA, 0.0) == pytest.approx(
        exact, rel=1e-12
    )
    stepper = CondensedStepper(
        replace(system, mass=np.array([1e-30, 1e-14])), law, dt, CondensedState.rest_state(system, law)
    )
    sine = 1e-6 * np.sin(2 * np.pi / steps * np.arange(1, 20 * steps + 1))
    force = np.array([stepper.advance(speed) for speed in np.diff(sine, prepend=0.0) / dt])
    angle = 2 * np.pi / steps * np.arange(1, steps + 1)
    assert 2j * (force[-steps:] * np.exp(-1j * angle)).mean() / 1e-6 == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("broken", [[], [3, 40, 41]])
def test_naive_twin(beam_system, broken):
    """Six steps against dense, uncondensed equations, which add a Kelvin element that is absent as no motion."""
    dt, law = 5e-5, mixed(beam_system, (MAXWELL, BURGERS, BURGERS))
    state = CondensedState.rest_state(beam_system, law)
    state.broken = list(broken)
    stepper, twin = CondensedStepper(beam_system, law, dt, state), NaiveState.at_rest(beam_system, law)
    absent = law.kelvin_springs == 0.0
    naive = replace_absent(law, absent)
    for n in range(6):
        driven = 1e-8 * np.cos(250 * dt * n)
        force = stepper.advance(driven)
        twin, expected = naive_step(beam_system, naive, dt, twin, driven, broken)
        assert force == pytest.approx(expected, rel=1e-9)
        for name in ("sigma", "velocity", "displacement", "memory"):
            one, other = getattr(stepper.state, name), getattr(twin, name)
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())
    assert absent.any() and not absent.all()


def replace_absent(law: BondLaws, absent: np.ndarray) -> BondLaw:
    """The same with elements too stiff to move in place of absent ones, as the twin has them everywhere."""
    return BondLaw(law.spring, law.dashpot, np.where(absent, 1e30, law.kelvin_springs), law.kelvin_dashpots)


@pytest.mark.parametrize("name", ["euler", "fitted"])
def test_stepping_is_the_frequency_domain(beam_system, name):
    """A specimen whose bonds differ, along and across: forces of the last cycle, to what transients leave."""
    system, law = replace(beam_system, load=np.zeros_like(beam_system.load)), mixed(beam_system, TABLE)
    sine = 1e-7 * np.sin(2 * np.pi / 100 * np.arange(1, 1601))
    found = stiffness(followed(march(system, law, DT, name), sine), 100, 1e-7)
    dt = DT if name == "euler" else 0.0
    rate = (1 - np.exp(-1j * OMEGA * dt)) / dt if dt else 1j * OMEGA
    exact = driving_force(system, law.discrete_modulus(OMEGA, dt), OMEGA, rate**2)
    assert found == pytest.approx(exact, rel=5e-6)


def test_the_tangents_have_their_own_law():
    """A bond pulled along its normal follows one law, along a tangent the other."""
    laws = BondLaws.of_bonds((STONE, SOLID), np.array([0]), np.array([1]))
    for row, law in ((0, STONE), (1, SOLID), (2, SOLID)):
        rows = np.zeros((3, 2))
        rows[row], rows[row - 1] = [1, 0], [0, 1]
        head = system_of(rows, 2e-3, [1.0, 1.0], driven=0)
        stiffness = driving_force(head, laws.discrete_modulus(OMEGA, 0.0), OMEGA, 0.0)
        assert stiffness == pytest.approx(2e-3 * law.discrete_modulus(OMEGA, 0.0), rel=1e-12)


def test_the_stiffer_of_two_bonds_breaks():
    """Side by side, as strong as each other: the stone breaks first, at its strength, and the soft one goes on."""
    system = replace(between((1e-3, 1e-3), series=False), strength=np.array([100.0, 100.0, np.inf]))
    soft, dt, speed = replace(STONE, spring=6e9), 1e-4, 1e-3
    law = BondLaws.of_bonds((STONE, soft), np.array([1, 0, 0]))
    stepper = CondensedStepper(system, law, dt, CondensedState.rest_state(system, law))
    for n in range(1, 41):
        force = stepper.advance(-speed) - (-system.mass[0] * speed / dt if n == 1 else 0.0)
        opening = n * dt * speed
        whole = opening * 60e9 * 1e-3 <= 100.0
        assert stepper.state.broken == ([] if whole else [1])
        assert force == pytest.approx(-opening * 1e-3 * (soft.spring + whole * STONE.spring), rel=1e-9)
    assert stepper.state.broken == [1]


def test_the_reduced_model_refuses(beam_system):
    model = ReducedModel(beam_system, ritz_basis(beam_system, 2))
    with pytest.raises(TypeError, match="one law for all bonds"):
        ReducedStepper(model, mixed(beam_system, TABLE), 1e-4, 1e-6)
