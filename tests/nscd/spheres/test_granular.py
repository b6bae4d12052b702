"""Spheres and planes: textbook motions, conservation, energy, penetration, and the naive twin."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import naive_step

from asphalt_nscd.nscd.spheres.gauss_seidel import (
    COUNT,
    NOTED,
    RELAXATION,
    ROUND,
    sweep_contacts,
    sweep_until,
)
from asphalt_nscd.nscd.spheres.granular import pack_motion, pack_slab
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.deposit import settle
from asphalt_nscd.specimen.granulate import Granulate, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice

G = 9.81
R = 2.0**-9  # m; a power of two, so that spheres touch to the last digit


def numerics(**changes) -> PouringNumerics:
    """Solved to rounding, overlaps never undone."""
    tight = {"time_step": 1e-4, "tolerance": 1e-14, "most_sweeps": 5000, "recovery_speed": 0.0}
    return PouringNumerics(**tight | changes)


def balls(
    position, radius=R, box=(1.0, 1.0, 1.0), friction=0.5, restitution=0.0, gravity=(0, 0, -G)
) -> Granulate:
    position = np.atleast_2d(np.asarray(position, float))
    granulate = Granulate.in_box(
        position, np.broadcast_to(radius, len(position)).astype(float), box, 2600.0, friction, restitution
    )
    granulate.gravity = np.asarray(gravity, float)
    return granulate


def mass(granulate: Granulate) -> np.ndarray:
    return 1.0 / granulate.inverse_mass[: granulate.radius.size]


def pairs(granulate: Granulate):
    """(first, second, impulse on the second) of every listed pair."""
    first = np.repeat(np.arange(granulate.radius.size), np.diff(granulate._start))
    return zip(first, granulate._other, granulate.impulse)


def momentum(granulate: Granulate) -> np.ndarray:
    n = granulate.radius.size
    return mass(granulate) @ granulate.velocity[:n, :3]


def angular_momentum(granulate: Granulate) -> np.ndarray:
    n, m = granulate.radius.size, mass(granulate)[:, None]
    v, s = granulate.velocity[:n, :3], granulate.velocity[:n, 3:]
    return (m * np.cross(granulate.position, v) + 0.4 * m * granulate.radius[:, None] * s).sum(axis=0)


def energy(granulate: Granulate) -> float:
    """Kinetic and potential [J]."""
    return granulate.kinetic_energy() - float(mass(granulate) @ (granulate.position @ granulate.gravity))


def deepest(granulate: Granulate) -> float:
    """Largest penetration [m]."""
    return float(-min(granulate.contacts(1e-6)[1].min(initial=0.0), 0.0))


def on_incline(slope: float, friction: float, steps: int = 200) -> Granulate:
    tilted = (G * np.sin(slope), 0.0, -G * np.cos(slope))
    ball = balls([0.1, 0.5, R], friction=friction, gravity=tilted)
    for _ in range(steps):
        ball.advance(numerics())
    return ball


# The acceleration is constant, which implicit Euler integrates exactly: only rounding is left, 1e-11.


@pytest.mark.parametrize("slope", [0.2, 0.9])
def test_a_ball_rolls_with_five_sevenths(slope):
    friction = 2 / 7 * np.tan(slope) * 1.001
    ball = on_incline(slope, friction)
    speed = 5 / 7 * G * np.sin(slope) * ball.time
    np.testing.assert_allclose(ball.velocity[0], [speed, 0, 0, 0, speed, 0], atol=1e-11 * speed)
    assert abs(ball.position[0, 2] - R) < 1e-15


@pytest.mark.parametrize("slope", [0.2, 0.9])
def test_a_ball_slips_when_friction_is_below_two_sevenths_of_the_slope(slope):
    friction = 2 / 7 * np.tan(slope) * 0.999
    ball = on_incline(slope, friction)
    speed = G * (np.sin(slope) - friction * np.cos(slope)) * ball.time
    spin = 2.5 * friction * G * np.cos(slope) * ball.time
    assert speed > spin
    np.testing.assert_allclose(ball.velocity[0], [speed, 0, 0, 0, spin, 0], atol=1e-11 * speed)


def test_without_friction_a_ball_slides_and_does_not_turn():
    ball = on_incline(0.3, 0.0)
    np.testing.assert_allclose(ball.velocity[0], [G * np.sin(0.3) * ball.time, 0, 0, 0, 0, 0], atol=1e-12)


def test_backspin_brings_a_ball_back():
    """Pushed with v0 and backspin -s0 it ends rolling at (5 v0 - 2 s0)/7; s0 = 4 v0 returns it."""
    ball = balls([0.5, 0.5, R], friction=0.3)
    ball.velocity[0] = [0.1, 0, 0, 0, -0.4, 0]
    for _ in range(2000):
        ball.advance(numerics())
    np.testing.assert_allclose(ball.velocity[0], [-3 / 70, 0, 0, 0, -3 / 70, 0], atol=1e-13)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.8])
def test_bounce_speed(restitution):
    """The step of the impact reverses the speed of the step before it times e, to rounding."""
    ball = balls([0.5, 0.5, R + 1e-3], restitution=restitution)
    before = 0.0
    while ball.velocity[0, 2] <= before:
        before = ball.velocity[0, 2]
        ball.advance(numerics(time_step=1e-5))
        if ball.position[0, 2] == R:
            break
    if restitution:
        assert ball.velocity[0, 2] == pytest.approx(-restitution * before, rel=1e-12)
    assert before == pytest.approx(-np.sqrt(2 * G * 1e-3), rel=1e-3)


@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_bounce_height(restitution):
    """e^2 of the height of the fall; impact and apex are found to a step, hence first order in dt."""
    fall, errors = 5e-3, []
    for dt in (4e-5, 2e-5, 1e-5):
        ball = balls([0.5, 0.5, R + fall], restitution=restitution)
        lowest_first, previous = [], 0.0
        while not (lowest_first and ball.velocity[0, 2] < 0 < previous):
            previous = ball.velocity[0, 2]
            ball.advance(numerics(time_step=dt))
            if ball.velocity[0, 2] > 0:
                lowest_first.append(ball.position[0, 2])
        errors.append(max(lowest_first) - R - restitution**2 * fall)
    assert np.abs(errors[-1]) < 2e-3 * fall
    assert np.abs(errors[-1]) < 0.5 * np.abs(errors[0]) + 1e-3 * restitution**2 * fall


@pytest.mark.parametrize(("restitution", "ratio"), [(0.0, 1.0), (0.6, 1.0), (1.0, 3.0)])
def test_head_on_collision(restitution, ratio):
    """Spheres of unequal mass on one line: momentum, and e times the speed of approach."""
    pair = balls(
        [[0.4, 0.5, 0.5], [0.4 + R * (1 + ratio) + 1e-4, 0.5, 0.5]],
        [R, ratio * R],
        restitution=restitution,
        gravity=(0, 0, 0),
    )
    pair.velocity[0, 0], pair.velocity[1, 0] = 1.0, -0.5
    start = momentum(pair)
    for _ in range(10):
        pair.advance(numerics())
    m1, m2 = mass(pair)
    mean = (m1 - 0.5 * m2) / (m1 + m2)
    expected = [mean - restitution * 1.5 * m2 / (m1 + m2), mean + restitution * 1.5 * m1 / (m1 + m2)]
    if restitution == 0.0:  # the gap closes exactly, then both move on together
        assert deepest(pair) < 1e-17
    np.testing.assert_allclose(pair.velocity[:2, 0], expected, rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(momentum(pair), start, rtol=1e-14, atol=1e-17)
    assert not pair.velocity[:2, 1:].any()


def test_oblique_collision_conserves_momentum_and_angular_momentum():
    """Touching spheres with spin: linear and angular momentum to rounding, friction only dissipates."""
    pair = balls(
        [[0.5, 0.5, 0.5], [0.5 + 3 * R, 0.5, 0.5]],
        [R, 2 * R],
        restitution=0.5,
        friction=0.4,
        gravity=(0, 0, 0),
    )
    pair.velocity[0] = [1.0, 0.3, -0.2, 0.1, 0.7, -0.4]
    pair.velocity[1] = [-0.5, -0.2, 0.4, -0.3, 0.2, 0.9]
    before = momentum(pair), angular_momentum(pair), pair.kinetic_energy()
    pair.advance(numerics())
    assert pair.velocity[1, 0] - pair.velocity[0, 0] == pytest.approx(0.75, rel=1e-13)
    np.testing.assert_allclose(momentum(pair), before[0], rtol=1e-13)
    np.testing.assert_allclose(angular_momentum(pair), before[1], rtol=1e-12)
    assert pair.kinetic_energy() < before[2]


def cloud(seed, restitution, friction):
    """30 spheres of two sizes strewn over a narrow box, with random velocities and spins."""
    rng = np.random.default_rng(seed)
    box = (0.017, 0.016, 0.05)  # not a multiple of the diameters: three spheres must not wedge between walls
    position, radius = random_lattice(np.array([3e-3, 5e-3]), np.array([20, 10]), box, rng)
    granulate = balls(position, radius, box, friction, restitution)
    granulate.velocity[: radius.size] = rng.normal(0, 0.2, (radius.size, 6))
    return granulate


@pytest.mark.parametrize(("restitution", "friction"), [(0.0, 0.0), (0.0, 0.5), (0.5, 0.0), (0.5, 0.5)])
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


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_only_a_sweep_over_all_contacts_ends_a_step(tolerance):
    """Grains thrown together: where it ends, one more sweep over all changes no more than the last one;
    rounds cut short leave the change above the tolerance."""
    pile = cloud(3, 0.0, 0.5)
    for _ in range(150):
        pile.advance(numerics(tolerance=1e-3, most_sweeps=60))
    slabs, room = pile._slabs, pile._room
    numbers = range(slabs.begin.size - 1)
    for most_sweeps in (2 * ROUND - 1, 100 * ROUND):
        pile.impulse[:] = 0.0
        pack_motion(pile.velocity, pile.inverse_mass, 0, len(pile.velocity), room.motion)
        for slab in numbers:
            pack_slab(
                slab, pile.position, pile.radius, pile.velocity, pile.plane_point, pile.plane_normal, pile.impulse,
                slabs, room, 1e-4, 0.0, 0.0, np.inf, 3e-4,
            )  # fmt: skip
        room.packed[:, 6] = 0.0  # targets
        sweeps, change = sweep_until(
            0,
            1,
            np.zeros(24, int),
            slabs.begin,
            room,
            0.5,
            np.zeros(2),
            tolerance,
            np.inf,
            most_sweeps,
            most_sweeps,
        )
        if most_sweeps < 2 * ROUND:
            assert sweeps == most_sweeps
            assert change > tolerance
    assert sweeps % ROUND == 1
    assert change < tolerance
    once_more = [
        sweep_contacts(
            room.bodies, room.packed, room.motion, 0.5, room.everyone, slabs.begin[slab],
            slabs.begin[slab] + int(room.account[slab, COUNT]), 1.0, 0.0, np.inf, room.lively,
        )
        for slab in sorted(numbers, key=lambda slab: slab % 2)
    ]  # fmt: skip
    changed, size = np.sum(once_more, axis=0)[:2]
    assert 0.0 < np.sqrt(changed / size) < tolerance


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


def test_flying_cloud_conserves_momentum():
    """Many collisions far from any wall; gaps at impact let angular momentum err in first order of dt."""
    rng = np.random.default_rng(5)
    cells = np.stack(np.meshgrid(*[np.arange(4)] * 3), axis=-1).reshape(-1, 3)
    position = 0.5 + 2.2 * R * (cells + 0.05 * rng.random(cells.shape))
    swarm = balls(position, R * rng.uniform(0.7, 1.0, 64), restitution=0.5, gravity=(0, 0, 0))
    swarm.velocity[:64] = rng.normal(0, 0.5, (64, 6))
    linear, angular, kinetic = momentum(swarm), angular_momentum(swarm), swarm.kinetic_energy()
    scale = (mass(swarm) * np.linalg.norm(swarm.velocity[:64, :3], axis=1)).sum()
    for _ in range(300):
        swarm.advance(numerics(time_step=1e-5))
    assert swarm.kinetic_energy() < 0.9 * kinetic  # they did collide
    np.testing.assert_allclose(momentum(swarm), linear, atol=1e-14 * scale)
    np.testing.assert_allclose(angular_momentum(swarm), angular, atol=1e-4 * scale * R)


def test_column_carries_its_weight():
    """Eight balls one upon the other: every contact carries what lies above it, upwards on the upper."""
    n = 8
    height = R * (2 * np.arange(n) + 1)
    column = balls(np.column_stack([np.full((n, 2), 0.5), height]))
    settings = numerics()
    for _ in range(50):
        column.advance(settings)
    weight = mass(column)[0] * G * settings.time_step
    found = 0
    for first, second, impulse in pairs(column):
        above = n if second >= n else n - 1 - min(first, second)
        upwards = impulse if second < n and second > first else -impulse
        np.testing.assert_allclose(upwards, [0, 0, above * weight], rtol=1e-10, atol=1e-12 * weight)
        found += 1
    assert found == n
    assert np.abs(column.velocity[:n]).max() < 1e-12


def test_at_rest_contact_forces_balance_every_weight():
    """Forces and torques, signs and points of action taken afresh: to 1e-10 of a ball's weight."""
    pile = cloud(8, 0.0, 0.5)  # in which no grain turns any more
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


def meeting_gap(settings, velocity, plane_velocity):
    """Below which a pair takes part in a step: both as fast as the fastest grain, or a grain and a plane."""
    n = len(velocity) - len(plane_velocity)
    fastest = np.linalg.norm(velocity[:n, :3], axis=1).max() + 9.81 * settings.time_step
    return settings.margin + settings.time_step * (fastest + max(fastest, np.abs(plane_velocity).max()))


def slab_numbers(granulate: Granulate):
    """{(i, j): slab} of every listed pair in the order of visits, -1 with the last body."""
    slabs = granulate._slabs
    last = slabs.begin.size - 2
    number = np.repeat(np.arange(last + 1), np.diff(slabs.begin))
    number[number == last] = -1
    return dict(zip(zip(slabs.first.tolist(), slabs.second.tolist()), number.tolist()))


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
    rng = np.random.default_rng(9 if times == 1 else 16)
    position, radius = random_lattice(np.array([3e-3, 6e-3]), times * np.array([10, 3]), box, rng)
    pile = balls(position, radius, box, 0.4, restitution)
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
    position, velocity, impulses, points = pile.position.copy(), pile.velocity.copy(), {}, pile.plane_point
    velocity[radius.size :, :3] = plane_velocity
    touched, most_slabs = 0, 0
    for _ in range(25):
        pile.advance(settings, plane_velocity)
        slabs = slab_numbers(pile)
        most_slabs = max(most_slabs, *slabs.values())
        position, velocity, impulses = naive_step(
            position, radius, velocity, mass(pile), points, pile.plane_normal, pile.gravity, impulses,
            dt=settings.time_step, friction=0.4, restitution=restitution, recovery_speed=recovery_speed,
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
    pile = balls(position, radius, (0.012,) * 3, 0.4)
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
            dt=settings.time_step, friction=0.4, restitution=0.0, recovery_speed=0.0, allowed_overlap=0.0,
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


def sweeps_of_a_squeezed_grain(relaxation):
    """Until a light ball on the floor has stopped one 125 times as heavy, to 1e-6 of its speed."""
    bodies = np.array([[1, 0], [0, 2]], np.int32)  # heavy and light, light and floor
    packed = np.zeros((2, 8))
    packed[:, 2] = -1.0  # both normals point down
    packed[:, 7] = 1.0 / (1.0 + 1.0 / 125.0), 1.0
    motion = np.zeros((3, 8))
    motion[:, 3] = 1.0, 1.0 / 125.0, 0.0
    motion[:, 7] = 2.5 * motion[:, 3]
    motion[1, 2] = -1.0
    both, noted = np.arange(2, dtype=np.int32), np.empty(2, np.int32)
    for sweep in range(5000):
        if abs(motion[1, 2]) < 1e-6:
            np.testing.assert_allclose(packed[:, 5], -125.0, rtol=1e-5)  # both stop it
            return sweep
        sweep_contacts(bodies, packed, motion, 0.0, both, 0, 2, relaxation, np.inf, np.inf, noted)
    raise AssertionError("not at rest")


def test_over_relaxation_helps_a_squeezed_grain():
    """Plain sweeps leave 1/(1 + m/M) of the speed each; a third as many do here."""
    plain = sweeps_of_a_squeezed_grain(1.0)
    assert plain == pytest.approx(6.0 * np.log(10.0) / np.log(126.0 / 125.0), rel=0.01)
    assert sweeps_of_a_squeezed_grain(RELAXATION) < 0.35 * plain


def test_the_impulses_of_the_step_before_tell_what_is_quiet():
    """At rest almost no contact changes, and almost none is visited again."""
    pile = cloud(8, 0.0, 0.5)
    settle(pile, numerics(time_step=2e-4, tolerance=1e-6, most_sweeps=200), 1e-5, 3.0, lambda *_: None, "")
    sweeps, _ = pile.advance(numerics(time_step=2e-4, tolerance=1e-3, most_sweeps=60))
    account = pile._room.account[: pile._slabs.begin.size - 1]
    assert sweeps == 1
    assert account[:, COUNT].sum() > 50
    assert account[:, NOTED].sum() < 0.1 * account[:, COUNT].sum()
