"""Bonded and loose spheres in one world: turns, small strains, falls, fragments and loose grains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.spatial.transform import Rotation

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.world import Surroundings, World, WorldBonds, _Contacts

LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))
NONE = np.empty(0)
ELASTIC = BondLaw(1e9, np.inf, NONE, NONE)  # a spring alone
RADIUS, PITCH, DENSITY = 4e-3, 9e-3, 2400.0
FLOOR = Surroundings(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), ContactLaw(0.5, 0.5))
NOWHERE = Surroundings(np.array([[0.0, 0.0, -1e3]]), FLOOR.plane_normal, FLOOR.law, (0.0, 0.0, 0.0))


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


def world(position, bonds, around=FLOOR, dt=4e-4, law=LAW, velocity=None) -> World:
    n = len(position)
    made = World(position, np.full(n, RADIUS), mass(n), bonds, law, around, dt)
    made.throw(np.zeros((n, 6)) if velocity is None else velocity)
    return made


def spinning(position, omega) -> np.ndarray:
    """Velocities (n, 6) of a rigid body that turns about its middle."""
    turn = np.broadcast_to(np.asarray(omega, float), position.shape)
    return np.hstack([np.cross(turn, position - position.mean(axis=0)), turn])


def momenta(of: World) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum, the latter about the origin."""
    masses, motion = of.mass.reshape(-1, 6), of.velocity.reshape(-1, 6)
    linear = masses[:, :3] * motion[:, :3]
    return linear.sum(axis=0), (np.cross(of.position, linear) + masses[:, 3:] * motion[:, 3:]).sum(axis=0)


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
        assert _Contacts.near(touching).gap == pytest.approx(np.zeros(broken), abs=1e-15)


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_bonded_spheres_do_not_meet_whichever_is_larger(order):
    """Pairs come with the larger sphere first, whatever its number."""
    position, bonds = bar((2, 1, 1))
    radius = np.array([RADIUS, 0.5 * RADIUS])[order]
    position[1, 0] = position[0, 0] + radius.sum()
    of_two = World(position, radius, mass(2), bonds, LAW, NOWHERE, 4e-4)
    of_two.throw(np.zeros((2, 6)))
    assert _Contacts.near(of_two).gap.size == 0
    of_two.broken[:] = True
    assert _Contacts.near(of_two).gap.size == 1


def test_what_would_break_for_ever_is_refused():
    with pytest.raises(ValueError, match="^strength: each bond's must be greater than zero"):
        world(*bar((2, 1, 1), strength=0.0))
    endless = world(*bar((2, 1, 1)), NOWHERE)
    endless.sigma[0] = np.nan
    with pytest.raises(ArithmeticError, match="the motion of a step is not finite"):
        endless.advance()


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
    small = CondensedStepper(system, LAW, dt, CondensedState.rest_state(system, LAW))
    start = np.zeros((n, 6))
    start[:, 2] = 1e-4 * np.cos(np.pi * position[:, 0] / position[-1, 0] * 2.0)
    large = world(position, bonds, NOWHERE, dt, velocity=start)
    small.state.velocity[:-1] = start.ravel()
    for _ in range(100):
        large.advance()
        small.advance(0.0)
    shown = small.state.displacement[:-1].reshape(-1, 6)[:, :3]
    np.testing.assert_allclose(large.position - position, shown, atol=1e-6 * np.abs(shown).max())
    np.testing.assert_allclose(large.sigma, small.state.sigma, atol=3e-5 * np.abs(small.state.sigma).max())


def test_a_rod_that_spins_keeps_its_momentum_energy_and_stretch():
    """Two turns in free flight, 2 % of a radian in a step; with G half a step ahead each costs 5.4 % of the spin."""
    position, bonds = bar((10, 1, 1))
    rod = world(position, bonds, NOWHERE, 2e-4, ELASTIC, spinning(position, [0.0, 0.0, 100.0]))
    start, set_free = momenta(rod)[1], rod.energies.actuator
    for _ in range(round(4.0 * np.pi / 100.0 / rod.dt)):
        rod.advance()
    assert np.linalg.norm(momenta(rod)[1] - start) < 2e-11 * np.linalg.norm(start)
    assert rod.energies.kinetic == pytest.approx(set_free, rel=1e-4)
    assert abs(rod.energies.error) < 1e-8 * set_free and abs(rod.energies.numerical) < 1e-4 * set_free
    # the bond in the middle bears the centrifugal force of either half
    arms = position[5:, 0] - position[:, 0].mean()
    pull = -(rod.weight * rod.sigma).reshape(-1, 3)[bonds.first == 4, 0]
    assert pull == pytest.approx(mass(1)[0, 0] * 100.0**2 * arms.sum(), rel=2e-3)


@pytest.mark.parametrize("strength", [np.inf, 1.0])
def test_two_bars_that_collide_keep_both_momenta(strength):
    """With friction, both spinning; bars of weak bonds break. The energy that they had is accounted for."""
    position, bonds = bar((4, 2, 2), strength)
    n, turn = len(position), Rotation.from_rotvec([0.2, 0.3, 0.9])
    aside = position.mean(axis=0) + [0.01, 0.006, 0.03]

    def moved(place: np.ndarray) -> np.ndarray:
        return turn.apply(place - position.mean(axis=0)) + aside

    pair = WorldBonds(
        np.append(bonds.first, bonds.first + n),
        np.append(bonds.second, bonds.second + n),
        np.vstack([bonds.frame, bonds.frame @ turn.as_matrix().T]),
        np.vstack([bonds.point, moved(bonds.point)]),
        np.tile(bonds.weight, 2),
        np.tile(bonds.strength, 2),
    )
    start = np.vstack([spinning(position, [20.0, 0.0, 10.0]), spinning(moved(position), [0.0, -30.0, 15.0])])
    start[n:, 2] -= 1.5
    both = world(np.vstack([position, moved(position)]), pair, NOWHERE, 2e-4, velocity=start)
    before, hits = momenta(both), 0
    for _ in range(60):
        hits += both.advance()
    assert hits > 3 and both.broken.any() == np.isfinite(strength)
    for now, then in zip(momenta(both), before, strict=True):
        assert np.linalg.norm(now - then) < 1e-11 * np.linalg.norm(then)
    energies = both.energies
    assert min(energies.impact, energies.friction) > 0.01 * energies.actuator
    assert abs(energies.error) < 1e-8 * energies.actuator


@pytest.mark.parametrize(
    "law",
    [
        ELASTIC,
        BondLaw(24.3e9, 3.71e7, NONE, NONE),
        BondLaw(24.3e9, np.inf, np.array([4e10, 1e9]), np.array([8e6, 2e7])),
    ],
)
def test_any_chain_falls_and_its_account_closes(law):
    """A spring alone, a Maxwell chain, and a solid of two Kelvin elements."""
    position, bonds = bar((4, 2, 2))
    turn = Rotation.from_rotvec([0.3, 0.5, 0.0])
    bonds = replace(
        bonds, frame=bonds.frame @ turn.as_matrix().T, point=turn.apply(bonds.point) + [0.0, 0.0, 0.02]
    )
    falling = world(turn.apply(position) + [0.0, 0.0, 0.02], bonds, law=law)
    for _ in range(250):
        falling.advance()
    energies = falling.energies
    assert energies.impact > 0.5 * -energies.load > 0.0
    assert abs(energies.error) < 1e-8 * -energies.load
    assert (energies.dashpots > 0.0) == (law is not ELASTIC)


@pytest.mark.parametrize("strength, breaks", [(0.1, True), (0.2, False)])
def test_a_bond_pulled_beyond_its_strength_breaks(strength, breaks):
    """Two spheres of 0.64 g part at 0.2 m/s: to stop them within 0.4 ms takes 0.16 N."""
    position, bonds = bar((2, 1, 1), strength)
    start = np.zeros((2, 6))
    start[:, 0] = [-0.1, 0.1]
    pair = world(position, bonds, NOWHERE, velocity=start)
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
    """Thrown along the floor it rolls at 5/7 of its speed; friction has taken 2/7 of its energy.

    The floor is rough, spheres are not: the two are not to be exchanged.
    """
    rough = replace(FLOOR, law=ContactLaw(0.0, 0.5))
    along = np.array([[0.1, 0.0, 0.0, 0.0, 0.0, 0.0]])
    ball = world(np.array([[0.0, 0.0, RADIUS]]), bar((1, 1, 1))[1], rough, 1e-4, velocity=along)
    for _ in range(400):
        ball.advance()
    start = 0.5 * ball.mass[0] * 0.1**2
    assert ball.velocity[0] == pytest.approx(0.1 * 5 / 7, rel=1e-9)
    assert ball.energies.friction == pytest.approx(start * 2 / 7, rel=1e-9)
    assert abs(ball.energies.numerical) < 1e-9 * start and abs(ball.energies.impact) < 1e-9 * start
