"""Bonded and loose spheres in one world: turns, small strains, falls, fragments and loose grains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.spatial.transform import Rotation

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.world import Surroundings, World, WorldBonds, _Contacts

LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))
RADIUS, PITCH, DENSITY = 4e-3, 9e-3, 2400.0
FLOOR = Surroundings(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), 0.5, 0.5)
NOWHERE = Surroundings(np.array([[0.0, 0.0, -1e3]]), FLOOR.plane_normal, 0.5, 0.5, (0.0, 0.0, 0.0))


def bar(shape=(6, 2, 2), strength=np.inf) -> tuple[np.ndarray, WorldBonds]:
    """Spheres on a lattice, neighbours bonded."""
    places = np.indices(shape).reshape(3, -1).T
    position = PITCH * places + RADIUS
    first, second = np.nonzero(np.abs(places[:, None] - places[None]).sum(axis=2) == 1)
    first, second = first[first < second], second[first < second]
    axis = np.argmax(places[second] - places[first], axis=1)
    frame = np.eye(3)[(axis[:, None] + np.arange(3)) % 3]
    bonds = WorldBonds(
        first,
        second,
        frame,
        0.5 * (position[first] + position[second]),
        np.tile([2e-3, 1e-3, 1e-3], first.size),
        np.full(first.size, strength),
    )
    return position, bonds


def mass(count: int) -> np.ndarray:
    one = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3
    return np.tile([one] * 3 + [0.4 * one * RADIUS**2] * 3, (count, 1))


def world(position, bonds, around=FLOOR, dt=4e-4) -> World:
    n = len(position)
    return World(position, np.full(n, RADIUS), mass(n), bonds, LAW, around, dt)


def test_a_rigid_rotation_opens_no_bond():
    """By half a radian, about a slanted axis; by small displacements it would be 0.12 of the length."""
    position, bonds = bar()
    turned = world(position, bonds)
    turn = Rotation.from_rotvec(0.5 * np.array([0.36, 0.48, 0.8]))
    turned.position, turned.rotation = turn.apply(position) + [0.1, -0.2, 0.3], turn * turned.rotation
    assert np.abs(turned.opening()).max() / PITCH < 1e-10
    turned.position[0] += 1e-6 * turn.apply(bonds.frame[0, 0])  # what does open one is seen along its axes
    assert turned.opening()[0] == pytest.approx(-1e-6, rel=1e-6)


def test_only_spheres_that_no_bond_joins_meet():
    """A cube of touching spheres, far from the floor: the broken bonds, in whatever order their ends are told."""
    position, bonds = bar((2, 2, 2))
    touching = world(
        position * (2.0 * RADIUS / PITCH), replace(bonds, first=bonds.second, second=bonds.first), NOWHERE
    )
    for broken in range(len(bonds.first)):
        touching.broken[:] = np.arange(len(bonds.first)) < broken
        assert _Contacts.near(touching, touching.position).gap == pytest.approx(np.zeros(broken), abs=1e-15)


def test_small_strains_are_those_of_small_displacements():
    """A bar that vibrates by a nanometre: motion and stresses of the condensed stepper, which a slope of 1e-6 joins."""
    position, bonds = bar()
    n, dt = len(position), 2e-6
    operator = opening_operator(bonds.first, bonds.second, bonds.frame, bonds.point, position)
    beside = sparse.hstack([operator, sparse.csr_matrix((operator.shape[0], 1))]).tocsr()
    system = BondedSystem(
        beside,
        bonds.weight,
        np.append(mass(n), 1.0),
        np.zeros(6 * n + 1),
        6 * n,
        np.full(bonds.first.size, 1e-3),
        bonds.strength,
        0.5,
    )
    small = CondensedStepper(system, LAW, dt, CondensedState.at_rest(system, LAW))
    large = world(position, bonds, NOWHERE, dt)
    start = np.zeros((n, 6))
    start[:, 2] = 1e-4 * np.cos(np.pi * position[:, 0] / position[-1, 0] * 2.0)
    large.velocity = start.ravel().copy()
    small.state.velocity[:-1] = start.ravel()
    for _ in range(100):
        large.advance()
        small.advance(0.0)
    shown = small.state.displacement[:-1].reshape(-1, 6)[:, :3]
    np.testing.assert_allclose(large.position - position, shown, atol=1e-6 * np.abs(shown).max())
    np.testing.assert_allclose(large.sigma, small.state.sigma, atol=3e-5 * np.abs(small.state.sigma).max())


def test_a_bar_that_spins_keeps_its_momentum_and_shape():
    """One turn in free flight, in 100 and 200 steps: spin lost by implicit Euler halves with the step."""
    position, bonds = bar((4, 1, 1))
    lost = []
    for steps in (100, 200):
        free = world(position, bonds, NOWHERE, 0.2 / steps)
        arms = position - position.mean(axis=0)
        omega = np.array([0.0, 0.0, 2.0 * np.pi / 0.2])
        start = np.zeros((4, 6))
        start[:, :3], start[:, 3:] = np.cross(omega, arms), omega
        free.velocity = start.ravel().copy()
        spin = [_spin(free)]
        for _ in range(steps):
            free.advance()
        spin.append(_spin(free))
        lost.append(1.0 - spin[1] / spin[0])
        assert abs(free.energies.error - 0.5 * mass(4).ravel() @ start.ravel() ** 2) < 1e-12
        assert np.linalg.norm(free.opening()) < 1e-3 * PITCH
        np.testing.assert_allclose(free.velocity.reshape(-1, 6)[:, :3].sum(axis=0), 0.0, atol=1e-9)
    assert 0.0 < lost[1] < 0.15
    assert lost[0] / lost[1] == pytest.approx(2.0, abs=0.3)


def _spin(of: World) -> float:
    """Angular momentum about the middle, along z."""
    masses, motion = of.mass.reshape(-1, 6), of.velocity.reshape(-1, 6)
    arms = of.position - of.position.mean(axis=0)
    orbital = np.cross(arms, masses[:, :3] * motion[:, :3]).sum(axis=0)
    return float((orbital + (masses[:, 3:] * motion[:, 3:]).sum(axis=0))[2])


@pytest.mark.parametrize("strength, breaks", [(0.1, True), (0.2, False)])
def test_a_bond_pulled_beyond_its_strength_breaks(strength, breaks):
    """Two spheres of 0.64 g part at 0.2 m/s: to stop them within 0.4 ms takes 0.16 N."""
    position, bonds = bar((2, 1, 1), strength)
    pair = world(position, bonds, NOWHERE)
    start = np.zeros((2, 6))
    start[:, 0] = [-0.1, 0.1]
    pair.velocity = start.ravel().copy()
    pair.advance()
    assert pair.broken.tolist() == [breaks]
    assert len(set(pair.fragments().tolist())) == 1 + breaks
    assert np.allclose(pair.velocity, start.ravel(), rtol=1e-12, atol=1e-12) == breaks


def test_an_impact_takes_what_its_impulse_takes_at_the_mean_velocity():
    """A sphere that falls on the floor loses its energy there; the part of implicit Euler is that of the flight."""
    position = np.array([[0.0, 0.0, RADIUS + 0.0125]])
    one = world(position, bar((1, 1, 1))[1])
    for _ in range(250):  # 0.1 s, twice as long as the fall
        one.advance()
    energies = one.energies
    assert energies.kinetic < 1e-20 and abs(energies.error) < 1e-15
    assert energies.impact == pytest.approx(-energies.load, rel=1e-9)
    assert abs(energies.numerical) < 1e-9 * energies.impact


def test_a_sliding_sphere_loses_by_friction_what_theory_says():
    """Thrown along the floor it rolls at 5/7 of its speed; friction has taken 2/7 of its energy."""
    ball = world(np.array([[0.0, 0.0, RADIUS]]), bar((1, 1, 1))[1], dt=1e-4)
    ball.velocity[0] = 0.1
    for _ in range(400):
        ball.advance()
    start = 0.5 * ball.mass[0] * 0.1**2
    assert ball.velocity[0] == pytest.approx(0.1 * 5 / 7, rel=1e-9)
    assert ball.energies.friction == pytest.approx(start * 2 / 7, rel=1e-9)
    assert abs(ball.energies.numerical) < 1e-9 * start and abs(ball.energies.impact) < 1e-9 * start
