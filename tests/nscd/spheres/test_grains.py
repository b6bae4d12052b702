"""One grain on a plane, and two that meet: textbook motions."""

from __future__ import annotations

import numpy as np
import pytest
from nscd.spheres.grains import (
    G,
    R,
    angular_momentum,
    balls,
    deepest,
    mass,
    momentum,
    numerics,
    on_incline,
)

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
