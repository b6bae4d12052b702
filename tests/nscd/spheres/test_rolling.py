"""Friction of rolling: one law with a couple, asked by the sweeps of pouring and by the solver of a world."""

from __future__ import annotations

import numpy as np
import pytest
from theory.grains import G, R, advanced, angular_momentum, balls, cloud, energy, mass, momentum, numerics

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.nscd.world import Surroundings, World, WorldBonds

SLOPE, ROLLING, SPEED = 0.3, 0.2, 0.05
DT = numerics().time_step


def world(position: np.ndarray, law: ContactLaw, gravity, velocity: np.ndarray) -> World:
    """Loose spheres of radius R on a floor; velocities (n, 6) with angular velocities."""
    n, none = len(position), np.empty(0)
    m = 2600.0 * 4.0 / 3.0 * np.pi * R**3
    bonds = WorldBonds(*np.empty((2, 0), int), np.empty((0, 3, 3)), np.empty((0, 3)), none, none)
    floor = Surroundings(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), law, tuple(gravity))
    inertia = np.tile([m] * 3 + [0.4 * m * R**2] * 3, (n, 1))
    made = World(
        np.array(position), np.full(n, R), inertia, bonds, BondLaw(1e9, np.inf, none, none), floor, DT
    )
    made.throw(velocity)
    return made


def down(slope: float) -> tuple[float, float, float]:
    return G * np.sin(slope), 0.0, -G * np.cos(slope)


def poured_down(rolling: float):
    return advanced(balls([0.1, 0.5, R], friction=0.5, gravity=down(SLOPE), rolling=rolling), 200).velocity[0]


def fallen_down(rolling: float):
    ball = world([[0.1, 0.5, R]], ContactLaw(0.5, 0.5, rolling), down(SLOPE), np.zeros((1, 6)))
    for _ in range(200):
        ball.advance()
    return ball.velocity * [1.0, 1.0, 1.0, R, R, R]


@pytest.mark.parametrize("ball", [poured_down, fallen_down])
def test_a_sphere_on_a_slope_rests_below_its_friction_of_rolling_and_rolls_above(ball):
    assert np.abs(ball(1.01 * np.tan(SLOPE))).max() < 1e-9
    speed = 5.0 / 7.0 * G * (np.sin(SLOPE) - 0.8 * np.tan(SLOPE) * np.cos(SLOPE)) * 200 * DT
    np.testing.assert_allclose(ball(0.8 * np.tan(SLOPE)), [speed, 0, 0, 0, speed, 0], rtol=1e-7, atol=1e-9)


def test_a_rolling_sphere_stops_and_its_energy_is_accounted_for():
    """v2 = 2 (5/7) rolling g x; steps by the velocity at their ends make x shorter by v dt/2."""
    distance = 7.0 * SPEED**2 / (10.0 * ROLLING * G) - 0.5 * SPEED * DT
    steps = int(1.1 * SPEED / (5.0 / 7.0 * ROLLING * G) / DT)
    poured = balls([0.1, 0.5, R], friction=0.5, rolling=ROLLING)
    poured.velocity[0] = [SPEED, 0, 0, 0, SPEED, 0]
    advanced(poured, steps)
    start = np.array([[SPEED, 0, 0, 0, SPEED / R, 0]])
    fallen = world([[0.1, 0.5, R]], ContactLaw(0.5, 0.5, ROLLING), (0.0, 0.0, -G), start)
    for _ in range(steps):
        fallen.advance()
    for place, motion in ((poured.position, poured.velocity[0]), (fallen.position, fallen.velocity)):
        assert place[0, 0] - 0.1 == pytest.approx(distance, rel=1e-5) and np.abs(motion).max() < 1e-9
    energies = fallen.energies
    assert energies.friction == pytest.approx(energies.actuator, rel=1e-8)
    assert abs(energies.error) < 1e-12 * energies.actuator


def test_a_spinning_top_is_stopped_by_its_couple():
    """About the normal Coulomb's friction takes nothing: (2/5) m R2 w' = -rolling m g R."""
    top = balls([0.5, 0.5, R], friction=0.5, rolling=ROLLING)
    top.velocity[0, 5] = SPEED
    rate = 2.5 * ROLLING * G
    advanced(top, 60)
    np.testing.assert_allclose(top.velocity[0], [0, 0, 0, 0, 0, SPEED - rate * 60 * DT], atol=1e-10)


@pytest.mark.parametrize("seed", range(4))
def test_two_spheres_that_collide_keep_both_momenta_and_are_those_of_a_world(seed):
    """By two solvers: sweeps in lanes, and forces and couples in turn on the Delassus operator."""
    position = np.array([[0.5, 0.5, 0.5], [0.5 + 2.0 * R, 0.5, 0.5]])
    thrown = np.random.default_rng(seed).normal(0.0, 0.1, (2, 6))
    thrown[:, 0] = 0.3, -0.3
    pair, smooth = (
        balls(position, friction=0.4, gravity=(0, 0, 0), rolling=rolling) for rolling in (0.3, 0.0)
    )
    pair.velocity[:2] = smooth.velocity[:2] = thrown
    before, spin = momentum(pair), angular_momentum(pair)
    twin = world(position, pair.law, (0, 0, 0), thrown / [1.0, 1.0, 1.0, R, R, R])
    advanced(pair, 1), advanced(smooth, 1)
    assert twin.advance() == 1 and np.abs(pair.velocity[:2] - smooth.velocity[:2]).max() > 1e-3
    np.testing.assert_allclose(momentum(pair), before, rtol=0, atol=1e-13 * mass(pair).sum())
    np.testing.assert_allclose(angular_momentum(pair), spin, rtol=0, atol=1e-13 * np.abs(spin).max())
    shown = twin.velocity.reshape(2, 6) * [1.0, 1.0, 1.0, R, R, R]
    np.testing.assert_allclose(pair.velocity[:2], shown, rtol=0, atol=1e-11)
    # the couple is at its limit and against the angular velocity that is left, or leaves none
    mass_of_one, turned = mass(pair)[0], (pair.velocity[1, 3:] - pair.velocity[0, 3:]) / R
    impulse = mass_of_one * (pair.velocity[1, :3] - thrown[1, :3])
    arm = np.array([-R, 0.0, 0.0])
    couple = 0.4 * mass_of_one * R * (pair.velocity[1, 3:] - thrown[1, 3:]) - np.cross(arm, impulse)
    limit, speed = 0.3 * 0.5 * R * impulse[0], np.linalg.norm(turned)
    if np.linalg.norm(couple) < (1.0 - 1e-9) * limit:
        assert speed < 1e-9
    else:
        np.testing.assert_allclose(couple, -limit * turned / speed, rtol=0, atol=1e-9 * limit)


def test_a_pile_never_gains_energy_and_is_the_same_by_two_threads():
    """Sweeps over copies of some contacts carry their couples, too."""
    piles = []
    for members in (1, 2):
        pile = cloud(3, 0.0, 0.5, rolling=0.2)
        with Team(members) as pile.team:
            held = energy(pile)
            for _ in range(300):
                pile.advance(numerics(tolerance=1e-6, most_sweeps=2000))
                held, before = energy(pile), held
                assert held < before + 1e-9 * abs(before)
        piles.append(pile)
    assert piles[0].velocity.tobytes() == piles[1].velocity.tobytes()
