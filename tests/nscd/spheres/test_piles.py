"""Many grains: energy, momentum, penetration, balance at rest."""

from __future__ import annotations

import numpy as np
import pytest
from theory.grains import (
    G,
    R,
    balls,
    cloud,
    deepest,
    energy,
    mass,
    numerics,
    pairs,
)

from asphalt_nscd.specimen.deposit import settle
from asphalt_nscd.specimen.granular_bed import PouringNumerics


@pytest.mark.parametrize(("restitution", "friction"), [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5)])
def test_a_pile_never_gains_energy_and_does_not_penetrate(restitution, friction):
    """From flight to rest, at every step, to rounding.

    The linearised gap is never larger than the true one, so that only what the solver leaves can
    penetrate: 1e-7 m, 1e-4 of the smallest radius, at 1000 sweeps.
    """
    pile = cloud(3, restitution, friction)
    settings = numerics(time_step=2e-4, margin=3e-4, tolerance=1e-10, most_sweeps=1000)
    last = start = energy(pile)
    deep = 0.0
    for step in range(800):
        pile.advance(settings)
        now = energy(pile)
        assert now <= last + 1e-13 * start, f"gained {now - last} J in step {step}"
        last = now
        deep = max(deep, deepest(pile))
    assert deep < 1e-7
    assert last < 0.5 * start


def test_a_bouncing_pile_with_friction_comes_to_rest():
    """Newton's law of impact is known to create energy where high restitution meets friction (Kane's
    paradox): no step may gain more than 5 % of the motion left, and all of it must die out."""
    pile = cloud(3, 0.8, 0.5)
    settings = numerics(time_step=2e-4, margin=3e-4, tolerance=1e-10, most_sweeps=1000)
    start = energy(pile)
    for _ in range(800):
        before, moving = energy(pile), pile.kinetic_energy()
        pile.advance(settings)
        assert energy(pile) - before < 0.05 * moving
    assert pile.kinetic_energy() < 2e-2 * start


def test_penetration_under_the_numerics_of_the_preparation():
    """Impulses to 1e-3 in at most 60 sweeps, as when pouring: 4 % of the smallest radius in the thick of
    it, where grains hit each other at 0.2 m/s and more; 0.1 % at rest."""
    pile = cloud(4, 0.0, 0.2)
    deep = 0.0
    for _ in range(1000):
        pile.advance(PouringNumerics())
        deep = max(deep, deepest(pile))
    assert deep < 6e-5
    assert deepest(pile) < 1.5e-6


def test_at_rest_contact_forces_balance_every_weight():
    """Forces and torques, signs and points of action taken afresh: to 1e-10 of a ball's weight."""
    pile = cloud(9, 0.0, 0.5)  # in which no grain turns any more
    settle(pile, numerics(time_step=2e-4, tolerance=1e-6, most_sweeps=200), 1e-5, 3.0, lambda *_: None, "")
    settings = numerics(time_step=2e-4, most_sweeps=50000)
    for _ in range(20):
        pile.advance(settings)
    n, weight = pile.radius.size, mass(pile)[:, None] * pile.gravity * settings.time_step
    force, torque = weight.copy(), np.zeros((n, 3))
    for first, second, impulse in pairs(pile):
        if second < n:
            normal = pile.position[second] - pile.position[first]
            normal /= np.linalg.norm(normal)
            force[second] += impulse
            torque[second] -= np.cross(normal, impulse)
        else:
            normal = -pile.plane_normal[second - n]
        force[first] -= impulse
        torque[first] -= np.cross(normal, impulse)
        assert normal @ impulse >= 0.0
        assert np.linalg.norm(np.cross(normal, impulse)) <= 0.5 * (normal @ impulse) * (1 + 1e-12) + 1e-18
    size = np.linalg.norm(weight, axis=1)
    assert (np.linalg.norm(force, axis=1) / size).max() < 1e-10
    assert (np.linalg.norm(torque, axis=1) / size).max() < 1e-10


def test_a_plate_presses_with_what_its_drive_gives():
    """On a column at rest: every contact carries the balls above and the push, no matter how fast the drive."""
    n, push = 5, 3e-5
    column = balls(np.column_stack([np.full((n, 2), 0.5), R * (2 * np.arange(n) + 1)]))
    column.hang_wall(2 * n * R, 1e-3)
    column.drive[:] = -0.5, push
    settings = numerics()
    for _ in range(50):
        column.advance(settings)
    weight = mass(column)[0] * G * settings.time_step
    for first, second, impulse in pairs(column):
        above = 0 if second == n + 5 else n if second > n - 1 else n - 1 - min(first, second)
        assert abs(impulse[2]) == pytest.approx(above * weight + push, rel=1e-9)
    assert np.abs(column.velocity).max() < 1e-10
    assert column.touching_wall().tolist() == [n - 1]
