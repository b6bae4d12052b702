"""Full time stepping: single bonds, a block that lands, the naive twin, yield and contact."""

from __future__ import annotations

import numpy as np
import pytest
from naive.stepping import NaiveState, naive_step
from theory.specimens import system_of
from theory.test_contacts import G, block_on_ground
from theory.test_law import BURGERS, LAW

from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper

ELASTIC = BondLaw(1e10, 1e20, np.array([]), np.array([]))


def stepper(of: BondedSystem, law=LAW, dt=1e-4, broken=()) -> CondensedStepper:
    state = CondensedState.rest_state(of, law)
    state.broken = list(broken)
    return CondensedStepper(of, law, dt, state)


def test_relaxation_of_one_bond():
    """Wall - bond - head, pulled open by 1 um in one step: the drive pulls with g E(t), to O(dt).

    Degree of freedom 1 belongs to a loose body, since at least one must be free.
    """
    head = system_of([[1, 0], [0, 0], [0, 0]], weight=2e-3, mass=[0.2, 1.0])
    errors = []
    for dt in (4e-4, 2e-4, 1e-4):
        step = stepper(head, dt=dt)
        force = [step.advance(1e-6 / dt)] + [step.advance(0.0) for _ in range(round(0.04 / dt) - 1)]
        errors.append(force[-1] / (2e-3 * 1e-6 * BURGERS.relaxation_modulus(0.04)) - 1)
        assert step.state.displacement[0] == pytest.approx(1e-6, rel=1e-14)
    assert abs(errors[-1]) < 5e-3
    np.testing.assert_allclose(np.log2(np.abs(np.array(errors[:-1]) / errors[1:])), 1.0, atol=0.05)


def test_drive_accelerates_its_own_mass_against_the_load():
    """No bond acts on the driven body: force = m a - f."""
    alone = system_of([[0, 1], [0, 0], [0, 0]], weight=1.0, mass=[0.5, 1.0], load=[-2.0, 0.0])
    step = stepper(alone, dt=1e-3)
    assert step.advance(0.3) == pytest.approx(0.5 * 0.3 / 1e-3 + 2.0, rel=1e-14)
    assert step.advance(0.1) == pytest.approx(-0.5 * 0.2 / 1e-3 + 2.0, rel=1e-14)


@pytest.mark.parametrize("broken", [[], [3, 40, 41]])
def test_naive_twin(beam_system, quick_law, broken):
    """Six steps of the beam against dense, uncondensed equations, whose condition allows 1e-9."""
    dt = 5e-5
    step, state = stepper(beam_system, quick_law, dt, broken), NaiveState.at_rest(beam_system, quick_law)
    for n in range(6):
        driven = 1e-8 * np.cos(250 * dt * n)
        force = step.advance(driven)
        state, expected = naive_step(beam_system, quick_law, dt, state, driven, broken)
        assert force == pytest.approx(expected, rel=1e-9)
        stress = np.abs(state.sigma).max()
        np.testing.assert_allclose(step.state.sigma, state.sigma, rtol=0, atol=1e-9 * stress)
        fastest = np.abs(state.velocity).max()
        np.testing.assert_allclose(step.state.velocity, state.velocity, rtol=0, atol=1e-9 * fastest)
        np.testing.assert_allclose(
            step.state.memory, state.memory, rtol=0, atol=1e-9 * np.abs(state.memory).max()
        )
        furthest = np.abs(state.displacement).max()
        np.testing.assert_allclose(step.state.displacement, state.displacement, rtol=0, atol=1e-9 * furthest)


@pytest.mark.parametrize("count", [1, 7, 75])
def test_factors_after_breakages(beam_system, count):
    """Solutions with bonds removed, one after another, against a dense solve; more than 60
    removed bonds are factorised anew. The condition with loose bodies, 1e5, allows 1e-9."""
    rng = np.random.default_rng(count)
    broken = rng.permutation(beam_system.gap.size)[:count].tolist()
    shifted = ShiftedOperator(beam_system, 50.0)
    for n in range(count):
        shifted.remove(broken[: n + 1])
    weight = beam_system.weight.copy()
    for bond in broken:
        weight[3 * bond : 3 * bond + 3] = 0.0
    dense = np.diag(beam_system.mass) + 50.0 * beam_system.stiffness(weight).toarray()
    dense = dense[np.ix_(beam_system.free, beam_system.free)]
    force = rng.normal(size=(dense.shape[0], 2)) * np.sqrt(np.diag(dense))[:, None]
    expected = np.linalg.solve(dense, force)
    assert np.linalg.norm(dense @ shifted.solve(force) - force) < 1e-11 * np.linalg.norm(force)
    np.testing.assert_allclose(shifted.solve(force), expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(
        shifted.solve(force[:, 1]), shifted.solve(force)[:, 1], rtol=0, atol=1e-9 * np.abs(expected).max()
    )


def test_a_block_lands_and_stays():
    """Dropped by 0.2 mm with a spin about x: corners touch one by one, and they alone are contacts; none goes below
    the plane by 1e-12 m."""
    of = block_on_ground(np.array([0.0, 0.0, -G]), friction=0.5, gap=2e-4)
    step = stepper(of, dt=1e-4, broken=range(4))
    step.state.velocity[3] = 0.3
    touched, told = [], [0]
    step.on_contact = lambda gaps: told.append(len(gaps))
    for _ in range(600):
        step.advance(0.0)
        gap = of.gap + of.operator[::3] @ step.state.displacement
        assert gap.min() > -1e-12
        touched.append((gap < 1e-9).sum())
        assert max(told) <= max(touched)
    assert sorted(set(touched)) == [0, 2, 4] and touched[-1] == 4
    assert np.abs(step.state.velocity).max() < 1e-9


def test_the_drive_feels_the_contact_it_pushes_on():
    """Head - closed gap - body - spring - wall, the bond between head and body broken: the force on the
    head is what both masses and the spring take."""
    rows = np.zeros((6, 2))
    rows[0], rows[3] = [-1, 1], [0, -1]  # body minus head, wall minus body
    of = system_of(rows, 1e-3, [0.2, 0.3], gap=[1e-9, 1.0])
    step = stepper(of, ELASTIC, dt=1e-4, broken=[0])
    force = step.advance(1e-3)
    moved = 1e-7 - 1e-9
    assert step.state.displacement[1] == pytest.approx(moved, rel=1e-12)
    expected = 0.2 * 1e-3 / 1e-4 + 0.3 * moved / 1e-4**2 + 1e7 * moved
    assert force == pytest.approx(expected, rel=1e-9)


def bundle(strengths) -> BondedSystem:
    """A driven head, one strong bond to a light body, and from there parallel bonds to the wall."""
    rows = np.zeros((3 * (1 + len(strengths)), 2))
    rows[0] = [1, -1]  # head minus body
    rows[3::3] = [0, 1]  # body minus wall
    return system_of(rows, 1e-3, [1.0, 1e-6], strength=np.array([np.inf, *strengths]))


def test_yield_cascades_within_one_step():
    """Four bonds share the pull; the weakest goes first and its share overloads the others, one by one,
    until the body hangs loose. Broken bonds carry nothing."""
    of = bundle([0.39, 0.46, 0.30, 0.44])
    step = stepper(of, ELASTIC, dt=1e-4)
    # springs of 1e7 N/m: one of them in series with four parallel ones
    for opening, expected in ((1.0e-7, 0.8), (1.4e-7, 1.12)):
        velocity = (opening - step.state.displacement[0]) / 1e-4
        inertia = (velocity - step.state.velocity[0]) / 1e-4
        assert step.advance(velocity) - inertia == pytest.approx(expected, rel=1e-4)
        assert step.state.broken == []
    velocity = (1.6e-7 - step.state.displacement[0]) / 1e-4
    inertia = (velocity - step.state.velocity[0]) / 1e-4
    force = step.advance(velocity) - inertia
    assert step.state.broken == [3, 1, 4, 2]  # numbered after the strong bond 0
    assert abs(force) < 1e-2  # what the light body's inertia still asks for


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_no_yield_in_compression(sign):
    """The same motion breaks the bonds when it pulls and none when it pushes."""
    step = stepper(bundle([0.3] * 4), ELASTIC, dt=1e-4)
    step.advance(sign * 1.6e-7 / 1e-4)
    assert len(step.state.broken) == (4 if sign > 0 else 0)


def test_broken_bonds_carry_nothing(beam, beam_system, quick_law):
    """A sphere whose bonds are all cut falls freely between its neighbours, g t and no spin, to rounding."""
    loose = 10
    cut = np.flatnonzero((beam.network.first == loose) | (beam.network.second == loose))
    step = stepper(beam_system, quick_law, dt=1e-5, broken=cut.tolist())
    for _ in range(20):
        step.advance(1e-4)
    own = step.state.velocity[6 * loose : 6 * loose + 6]
    np.testing.assert_allclose(own, [0, 0, -G * 20e-5, 0, 0, 0], atol=1e-12)
    others = np.delete(np.arange(beam.radius.size), loose)
    assert np.abs(step.state.velocity[6 * others + 2] + G * 20e-5).min() > 1e-4
