"""Frictional contact: a block on a slope, and closed solutions of one contact."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd import solve_contacts
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from theory.specimens import elastic, system_of

G = 9.81
UPRIGHT = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # normal up, tangents


def block_on_ground(gravity: np.ndarray, friction: float, gap: float = 0.0) -> BondedSystem:
    """A block of 0.4 kg on four corners; a second body far away is the driven one.

    `gravity` (3,) in m/s2 is in the axes of the ground; `gap` is under each corner [m]. The corners are bonds, which
    act as contacts once they are broken.
    """
    corners = np.array([[x, y, -4e-3] for x in (-0.02, 0.02) for y in (-0.015, 0.015)])
    centres = np.array([[0.0, 0, 0], [9.0, 0, 0]])
    operator = opening_operator(
        np.full(4, 2), np.zeros(4, int), np.tile(UPRIGHT, (4, 1, 1)), corners, centres
    )
    inertia = 0.4 / 12 * np.array([0.03**2 + 0.008**2, 0.04**2 + 0.008**2, 0.04**2 + 0.03**2])
    mass = np.concatenate([[0.4] * 3, inertia, np.ones(6)])
    load = np.concatenate([0.4 * gravity, np.zeros(9)])
    return system_of(operator.toarray(), 1e-3, mass, 6, load, gap, friction=friction)


def slide(slope: float, friction: float, steps: int = 40, dt: float = 1e-3) -> np.ndarray:
    """Velocity (3,) [m/s] of the block on a slope, stepped from rest; zero below the angle of friction.

    Gravity leans by `slope` [rad], between the two tangents; `dt` in s.
    """
    # downhill lies between the tangents: a law for each tangent alone would pass along one of them
    gravity = G * np.array([np.sin(slope) * 0.6, np.sin(slope) * 0.8, -np.cos(slope)])
    system, law = block_on_ground(gravity, friction), elastic(1e9)
    state = CondensedState.at_rest(system, law)
    # contacts are bonds that have broken
    state.broken = list(range(4))
    stepper = CondensedStepper(system, law, dt, state)
    for _ in range(steps):
        stepper.advance(0.0)
    return state.velocity[:3]


def test_block(row):
    friction, moves = 0.5, "a = g (sin - mu cos)"
    angle = np.arctan(friction)
    below, above = slide(angle - 1e-3, friction), slide(angle + 1e-3, friction)
    rests, found = np.abs(below).max(), float(np.array([0.6, 0.8, 0.0]) @ above)
    expected = G * (np.sin(angle + 1e-3) - friction * np.cos(angle + 1e-3)) * 0.04
    row("block 1e-3 rad below the angle of friction, speed", 0.0, rests, 1e-11, "tan(slope) < mu: rests")
    row("block 1e-3 rad above the angle of friction, speed", expected, found, 1e-8, moves)


def test_one_contact(row):
    masses, source = np.diag([2.0, 7.0, 7.0]), "closed solution, cone of friction"
    for name, free, expected in (
        ("opens", [0.3, 1.0, -2.0], [0.0, 0.0, 0.0]),
        ("sticks", [-2.0, 1.4, -1.4], [1.0, -0.2, 0.2]),
        ("slips", [-2.0, 4.2, -5.6], [1.0, -0.24, 0.32]),
    ):
        found = solve_contacts(masses, np.array(free), 0.4, tolerance=1e-12).reactions
        error = float(np.abs(found - expected).max())
        row(f"one contact that {name}, error of the impulse", 0.0, error, 1e-10, source)
