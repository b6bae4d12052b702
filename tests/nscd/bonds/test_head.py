"""Devices at the head: their balance, their effect on the apparent stiffness, and the same built from bonds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.bonds.head_kernels import actuator_force, follow_actuator
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import actuator_stiffness, driving_force
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper

DT, FREQUENCY, OMEGA = 5e-5, 40.0, 80 * np.pi
ELASTIC = BondLaw(1e10, 1e22, np.array([]), np.array([]))
# of the order of the small beam, which takes 3e5 N/m
CLAMP = HeadDevices(clamp_compliance=2e-6)
ALL = HeadDevices(2e-6, 1e5, 0.0, 0.5)
SLIDING = HeadDevices(2e-6, 1e5, 0.03, 0.5)


def sine(amplitude, cycles=1.0, rest=20):
    time = DT * np.arange(1, round(cycles / FREQUENCY / DT) + 1)
    return np.concatenate([np.zeros(rest), amplitude * np.sin(OMEGA * time)])


def reduced(system, law, devices, vectors=12, tolerance=1e-6) -> ReducedStepper:
    return ReducedStepper(
        ReducedModel(system, ritz_basis(system, vectors)), law, DT, tolerance, devices=devices
    )


def full(system, law, devices) -> CondensedStepper:
    return CondensedStepper(system, law, DT, CondensedState.rest_state(system, law), devices)


def march(stepper, driven):
    return np.array([stepper.advance(v) for v in np.diff(driven, prepend=0.0) / DT])


def deviation(force, reference):
    return np.abs(force - reference).max() / np.abs(reference).max()


@pytest.mark.parametrize("clamp", [0.0, 1e-7])
@pytest.mark.parametrize("slider", [0.0, 30.0])
def test_balance_of_the_head(clamp, slider):
    """Clamp force = all that resists; the slider opposes motion with F_s, or holds with less."""
    rng, stuck = np.random.default_rng(2), 0
    for _ in range(200):
        devices = (clamp, 1e5, slider, 0.5)
        free_force, impedance = rng.normal(0, 20), rng.uniform(5, 500)
        actuator, x, v = rng.normal(0, 5e-6), rng.normal(0, 5e-6), rng.normal(0, 1e-3)
        velocity, friction = follow_actuator(devices, DT, free_force, impedance, actuator, x, v)
        taken = actuator_force(devices, DT, free_force + impedance * velocity, friction, x, v, velocity)
        moved = x + DT * velocity
        expected = free_force + impedance * velocity + friction + 1e5 * moved + 0.5 * (velocity - v) / DT
        assert taken == pytest.approx(expected, rel=1e-12)
        assert clamp * taken == pytest.approx(actuator - moved, abs=1e-9 * 5e-6)
        assert abs(friction) <= slider * (1 + 1e-12)
        if velocity:
            assert friction == slider * np.sign(velocity)
        stuck += velocity == 0.0
    assert (20 < stuck < 180) if clamp and slider else stuck == 0


def test_at_rest_a_rigid_clamp_leaves_the_slider_at_rest():
    assert follow_actuator((0.0, 1e5, 30.0, 0.5), DT, 7.0, 10.0, 1e-6, 1e-6, 0.0) == (0.0, 0.0)


WITHOUT_CLAMP = replace(ALL, clamp_compliance=0.0)


@pytest.mark.parametrize(
    ("devices", "method"),
    [
        *((one, reduced) for one in (CLAMP, HeadDevices(guide_stiffness=1e5), HeadDevices(head_mass=0.5))),
        *((one, method) for one in (ALL, WITHOUT_CLAMP) for method in (reduced, full)),
    ],
)
def test_apparent_stiffness(beam_system, quick_law, devices, method):
    """1/(C + 1/(H + k + m a)), H and a those of implicit Euler: to 1e-8, what is left of the transient."""
    rate = (1 - np.exp(-1j * OMEGA * DT)) / DT
    head = driving_force(beam_system, quick_law.discrete_modulus(OMEGA, DT), OMEGA, rate**2)
    expected = 1 / (
        devices.clamp_compliance + 1 / (head + devices.guide_stiffness + devices.head_mass * rate**2)
    )
    assert abs(expected / head - 1) > 0.05
    driven, stepper = sine(1e-7, cycles=8), method(beam_system, quick_law, devices)
    force = stepper.run(driven)[0] if method is reduced else march(stepper, driven)
    time = DT * np.arange(driven.size)
    found = harmonic_response(time, force, driven, FREQUENCY, cycles=2)
    stiffness = found.force_amplitude / found.displacement_amplitude * np.exp(1j * found.phase)
    assert abs(stiffness / expected - 1) < 1e-8


def with_actuator(system: BondedSystem, devices: HeadDevices, modulus: float) -> BondedSystem:
    """Clamp and guide spring as elastic bonds: the head is one more free body, the actuator is driven."""
    d, head = system.mass.size, system.driven
    rows = sparse.lil_matrix((6, d + 1))
    rows[0, d], rows[0, head], rows[3, head] = 1.0, -1.0, 1.0
    weight = np.zeros(6)
    weight[[0, 3]] = np.array([1 / devices.clamp_compliance, devices.guide_stiffness]) / modulus
    mass = np.append(system.mass, 0.0)
    mass[head] += devices.head_mass
    return BondedSystem(
        sparse.vstack([sparse.hstack([system.operator, sparse.csr_matrix((system.weight.size, 1))]), rows]).tocsr(),
        np.append(system.weight, weight), mass, np.append(system.load, 0.0), d,
        np.append(system.gap, [1.0, 1.0]), np.append(system.strength, [np.inf, np.inf]), system.friction,
    )  # fmt: skip


def test_frequency_domain_against_bonds(beam_system):
    """The same clamp, spring and mass among the bonds: a stiffness to rounding."""
    omega = 3e3
    expected = driving_force(with_actuator(beam_system, ALL, 1e10), 1e10, omega)
    assert actuator_stiffness(driving_force(beam_system, 1e10, omega), ALL, omega) == pytest.approx(
        expected, rel=1e-9
    )


@pytest.mark.parametrize("amplitude", [1e-6, 1e-4])
def test_devices_against_bonds_step_by_step(beam_system, amplitude):
    """Elastic bonds, some of which break at the larger amplitude, in the same order."""
    driven = sine(amplitude, cycles=0.4)
    twin = CondensedStepper(
        with_actuator(beam_system, ALL, 1e10),
        ELASTIC,
        DT,
        CondensedState.rest_state(with_actuator(beam_system, ALL, 1e10), ELASTIC),
    )
    reference = march(twin, driven)
    condensed, short = full(beam_system, ELASTIC, ALL), reduced(beam_system, ELASTIC, ALL)
    assert deviation(march(condensed, driven), reference) < 1e-9
    assert deviation(short.run(driven)[0], reference) < 1e-7
    assert condensed.state.broken == short.state.broken == twin.state.broken
    assert len(twin.state.broken) == 0 if amplitude == 1e-6 else len(twin.state.broken) > 1
    assert short.certificate().largest_residual <= 1e-6
    assert short.enrichments <= len(twin.state.broken) + 1


def test_contacts_behind_a_clamp(beam_system):
    """Gaps a thousand times narrower: closed ones hold the head back, and the clamp gives way."""
    system = replace(
        beam_system, gap=1e-3 * beam_system.gap, strength=np.full_like(beam_system.strength, np.inf)
    )
    driven = sine(6e-5, cycles=0.2)
    joined = with_actuator(system, ALL, 1e10)
    reference = march(
        CondensedStepper(joined, ELASTIC, DT, CondensedState.rest_state(joined, ELASTIC)), driven
    )
    wide = replace(system, gap=beam_system.gap)
    assert deviation(march(full(wide, ELASTIC, ALL), driven), reference) > 1e-3
    assert deviation(march(full(system, ELASTIC, ALL), driven), reference) < 1e-7
    short = reduced(system, ELASTIC, ALL)
    with pytest.raises(FullSystemNeeded, match="a gap closes") as closed:
        short.run(driven)
    done = closed.value.force.size
    assert 20 < done < driven.size - 20
    after = CondensedStepper(system, ELASTIC, DT, short.full_state(), ALL, driven[done - 1])
    continued = [after.advance(v) for v in np.diff(driven[done - 1 :]) / DT]
    assert deviation(np.concatenate([closed.value.force, continued]), reference) < 1e-7


def test_slider_behind_a_clamp(beam_system, quick_law):
    """Sticks and slips; at every step clamp force = specimen + devices + slider; reduced and full alike."""
    driven, stepper = sine(1e-6, cycles=2), full(beam_system, quick_law, SLIDING)
    clamp, spring, slider, mass = SLIDING.head_constants
    head, states, force = beam_system.driven, [], []
    for n, velocity in enumerate(np.diff(driven, prepend=0.0) / DT):
        x, v = stepper.state.displacement[head], stepper.state.velocity[head]
        force.append(stepper.advance(velocity))
        x, before, v = stepper.state.displacement[head], v, stepper.state.velocity[head]
        assert force[-1] == pytest.approx((driven[n] - x) / clamp, abs=1e-9)
        friction = force[-1] - stepper.missing[head] - spring * x - mass * (v - before) / DT
        assert abs(friction) <= slider * (1 + 1e-9)
        if v:
            assert friction == pytest.approx(slider * np.sign(v), abs=1e-9)
        states.append(np.sign(v))
    oscillation = np.array(states[20:])
    assert 10 < (oscillation == 0).sum() < 0.5 * oscillation.size
    assert (oscillation > 0).sum() > 100 and (oscillation < 0).sum() > 100
    short = reduced(beam_system, quick_law, SLIDING)
    assert deviation(short.run(driven)[0], np.array(force)) < 1e-7
    certificate = short.certificate()
    assert certificate.largest_residual <= 1e-6
    without = reduced(beam_system, quick_law, ALL).run(driven)[0]
    assert deviation(without, np.array(force)) > 0.02
