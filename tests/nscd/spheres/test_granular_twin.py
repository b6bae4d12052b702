"""Grains, planes and the driven wall beside the naive twin, to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import naive_step
from theory.grains import (
    balls,
    mass,
    numerics,
    pairs,
)

from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.granular_bed import GranularBed
from asphalt_nscd.specimen.lattice import random_lattice


def meeting_gap(settings, velocity, plane_velocity):
    """Below which a pair takes part in a step: both as fast as the fastest grain, or a grain and a plane."""
    n = len(velocity) - len(plane_velocity)
    fastest = np.linalg.norm(velocity[:n, :3], axis=1).max() + 9.81 * settings.time_step
    return settings.margin + settings.time_step * (fastest + max(fastest, np.abs(plane_velocity).max()))


def slab_numbers(bed: GranularBed):
    """{(i, j): slab} of every listed pair in the order of visits, -1 with the last body."""
    slabs = bed._slabs
    last = slabs.begin.size - 2
    number = np.repeat(np.arange(last + 1), np.diff(8 * slabs.begin))
    number[number == last] = -1
    first = np.repeat(np.arange(bed._start.size - 1), np.diff(bed._start))
    listed = [(int(first[pair]), int(bed._other[pair])) for pair in slabs.pair]
    return {pair: int(slab) for pair, slab, place in zip(listed, number, slabs.pair) if place >= 0}


@pytest.mark.parametrize("length", [0.012, 0.05])
@pytest.mark.parametrize(
    ("restitution", "recovery_speed", "allowed_overlap", "penetration"),
    [(0.0, 0.02, 0.0, np.inf), (0.5, 0.0, 0.0, np.inf), (0.0, 0.2, 4e-6, np.inf), (0.0, 0.02, 0.0, 1e-7)],
)
def test_naive_twin(restitution, recovery_speed, allowed_overlap, penetration, length):
    """A dozen balls thrown into a corner under a moving lid, or four dozen in four slabs or more, where two threads
    sweep them: all quantities to rounding, 1e-11. The seeds are such that rounding does not decide whether contacts
    which only touch are visited again."""
    box, times = (length, 0.012, 0.012), 1 if length == 0.012 else 4
    rng = np.random.default_rng(9 if times == 1 else 17)
    position, radius = random_lattice(np.array([3e-3, 6e-3]), times * np.array([10, 3]), box, rng)
    pile = balls(position, radius, box, 0.4, restitution, wall_friction=0.2)
    pile.team = Team(1 if times == 1 else 2)
    pile.velocity[: radius.size] = rng.normal(0, 0.5, (radius.size, 6))
    pile.position[1] = pile.position[0] + (radius[:2].sum() - 1e-5) * np.array([0.6, 0.0, 0.8])  # an overlap
    settings = numerics(
        most_sweeps=40,
        tolerance=1e-6 if penetration == np.inf else 1e-12,
        falling_sweeps=1_000_000 if penetration == np.inf else 6,
        falling_penetration=penetration,
        recovery_speed=recovery_speed,
        allowed_overlap=allowed_overlap,
        margin=1e-4,
    )
    plane_velocity = np.zeros((6, 3))
    plane_velocity[5] = [0.05, 0.0, -0.3]
    pile.velocity[radius.size :, :3] = plane_velocity
    position, velocity, impulses, points = pile.position.copy(), pile.velocity.copy(), {}, pile.plane_point
    touched, most_slabs = 0, 0
    for _ in range(16):
        pile.advance(settings)
        slabs = slab_numbers(pile)
        most_slabs = max(most_slabs, *slabs.values())
        position, velocity, impulses = naive_step(
            position, radius, velocity, mass(pile), points, pile.plane_normal, pile.gravity, impulses,
            dt=settings.time_step, friction=(0.4, 0.2), restitution=restitution, recovery_speed=recovery_speed,
            allowed_overlap=allowed_overlap,
            margin=meeting_gap(settings, velocity, plane_velocity), tolerance=settings.tolerance, most_sweeps=40,
            penetration=settings.falling_penetration, enough_sweeps=settings.falling_sweeps, slabs=slabs,
        )  # fmt: skip
        points = points + settings.time_step * plane_velocity
        np.testing.assert_allclose(pile.position, position, rtol=0, atol=1e-14)
        np.testing.assert_allclose(pile.velocity, velocity, rtol=0, atol=1e-11)
        listed = {(i, j): p for i, j, p in pairs(pile)}
        for pair in listed.keys() | impulses.keys():
            found, expected = (at.get(pair, np.zeros(3)) for at in (listed, impulses))
            np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-11 * mass(pile).max())
            touched += expected.any()
    assert touched > 100
    assert times == 1 or most_slabs >= 2


@pytest.mark.parametrize("push", [2e-4, 0.1])
def test_naive_twin_of_the_driven_wall(push):
    """A heap under a plate between rails, which yields to 0.5 N and keeps its speed at 250 N: to 1e-11."""
    rng = np.random.default_rng(9)
    position, radius = random_lattice(np.array([3e-3, 6e-3]), np.array([10, 3]), (0.012,) * 3, rng)
    pile = balls(position, radius, (0.012,) * 3, 0.4, wall_friction=0.2)
    pile.velocity[: radius.size] = rng.normal(0, 0.2, (radius.size, 6))
    pile.hang_wall(pile.top() + 1e-5, 2e-3)
    pile.drive[:] = -0.2, push
    masses = np.append(mass(pile), 2e-3)
    settings = numerics(time_step=4e-4, most_sweeps=60, tolerance=1e-7, margin=1e-4)
    position, velocity, impulses, points = pile.position.copy(), pile.velocity.copy(), {}, pile.plane_point
    yielded = touched = 0
    for _ in range(25):
        faster = np.abs(velocity[radius.size :, :3])  # or what the drive may make of the wall's speed
        faster[5, 2] = max(faster[5, 2], min(0.2, faster[5, 2] + push / 2e-3))
        pile.advance(settings)
        position, velocity, impulses = naive_step(
            position, radius, velocity, masses, points, pile.plane_normal, pile.gravity, impulses,
            dt=settings.time_step, friction=(0.4, 0.2), restitution=0.0, recovery_speed=0.0, allowed_overlap=0.0,
            margin=meeting_gap(settings, velocity, faster), tolerance=1e-7, most_sweeps=60,
            drive=pile.drive, slabs=slab_numbers(pile),
        )  # fmt: skip
        points = points + settings.time_step * velocity[radius.size :, :3]
        np.testing.assert_allclose(pile.position, position, rtol=0, atol=1e-14)
        np.testing.assert_allclose(pile.velocity, velocity, rtol=0, atol=1e-11)
        assert not pile.velocity[-1, [0, 1, 3, 4, 5]].any()
        yielded += pile.velocity[-1, 2] > -0.2 + 1e-9
        touched += pile.touching_wall().size
    assert touched > 20
    assert (yielded > 10) == (push < 1e-3)
