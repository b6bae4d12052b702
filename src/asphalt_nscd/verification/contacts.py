"""Frictional contact: a block on a slope, closed solutions, hyperstatic stacks, and the conditions themselves."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd import solve_contacts
from asphalt_nscd.nscd.bonds import BondedSystem, opening_operator
from asphalt_nscd.nscd.condensed import CondensedState, CondensedStepper
from asphalt_nscd.verification.row import Checks, Row
from asphalt_nscd.verification.specimens import elastic, system_of

checks = Checks()

G = 9.81
UPRIGHT = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # normal up, tangents


def block_on_ground(gravity: np.ndarray, friction: float, gap: float = 0.0) -> BondedSystem:
    """A block of 0.4 kg on four corners; a second body far away is the driven one."""
    corners = np.array([[x, y, -4e-3] for x in (-0.02, 0.02) for y in (-0.015, 0.015)])
    centres = np.array([[0.0, 0, 0], [9.0, 0, 0]])
    operator = opening_operator(
        np.full(4, 2), np.zeros(4, int), np.tile(UPRIGHT, (4, 1, 1)), corners, centres
    )
    inertia = 0.4 / 12 * np.array([0.03**2 + 0.008**2, 0.04**2 + 0.008**2, 0.04**2 + 0.03**2])
    mass = np.concatenate([[0.4] * 3, inertia, np.ones(6)])
    load = np.concatenate([0.4 * gravity, np.zeros(9)])
    return system_of(operator.toarray(), 1e-3, mass, 6, load, gap, friction)


def slide(slope: float, friction: float, steps: int = 40, dt: float = 1e-3) -> np.ndarray:
    """Velocity (3,) [m/s] of the block after so many steps from rest, gravity leaning by `slope` [rad]."""
    gravity = G * np.array([np.sin(slope) * 0.6, np.sin(slope) * 0.8, -np.cos(slope)])
    system, law = block_on_ground(gravity, friction), elastic(1e9)
    state = CondensedState.at_rest(system, law)
    state.broken = list(range(4))
    stepper = CondensedStepper(system, law, dt, state)
    for _ in range(steps):
        stepper.advance(0.0)
    return state.velocity[:3]


@checks
def block() -> list[Row]:
    friction = 0.5
    angle = np.arctan(friction)
    below, above = slide(angle - 1e-3, friction), slide(angle + 1e-3, friction)
    expected = G * (np.sin(angle + 1e-3) - friction * np.cos(angle + 1e-3)) * 0.04
    return [
        Row(
            "block 1e-3 rad below the angle of friction, speed",
            0.0,
            np.abs(below).max(),
            1e-11,
            "tan(slope) < mu: rests",
        ),
        Row(
            "block 1e-3 rad above the angle of friction, speed",
            expected,
            float(np.array([0.6, 0.8, 0.0]) @ above),
            1e-8,
            "a = g (sin - mu cos)",
        ),
    ]


@checks
def one_contact() -> list[Row]:
    masses, rows = np.diag([2.0, 7.0, 7.0]), []
    for name, free, expected in (
        ("opens", [0.3, 1.0, -2.0], [0.0, 0.0, 0.0]),
        ("sticks", [-2.0, 1.4, -1.4], [1.0, -0.2, 0.2]),
        ("slips", [-2.0, 4.2, -5.6], [1.0, -0.24, 0.32]),
    ):
        found = solve_contacts(masses, np.array(free), 0.4, tolerance=1e-12).reactions
        error = float(np.abs(found - expected).max())
        rows.append(
            Row(
                f"one contact that {name}, error of the impulse",
                0.0,
                error,
                1e-10,
                "closed solution, cone of friction",
            )
        )
    return rows


def wall(rows: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """(W, q) of a wall of bricks in running bond on the ground, under its weight in a step of 1 ms.

    Each brick rests on two lower ones by four corners each: highly hyperstatic, W far from full rank.
    """
    length, depth, height, mass, dt = 0.2, 0.1, 0.06, 2.0, 1e-3
    centres = np.array(
        [[(k + 0.5 * (r % 2)) * length, 0.0, (r + 0.5) * height] for r in range(rows) for k in range(across)]
    )
    bodies = len(centres)
    first, second, point = [], [], []
    for n, centre in enumerate(centres):
        for m in [bodies] if n < across else range(bodies):
            if m < bodies:
                lower = centres[m]
                left, right = (
                    np.maximum(centre[0], lower[0]) - length / 2,
                    np.minimum(centre[0], lower[0]) + length / 2,
                )
                if abs(centre[2] - lower[2] - height) > 1e-9 or right - left < 1e-9:
                    continue
            else:
                left, right = centre[0] - length / 2, centre[0] + length / 2
            for x in (left, right):
                for y in (-depth / 2, depth / 2):
                    first.append(m)
                    second.append(n)
                    point.append([x, y, centre[2] - height / 2])
    contacts = len(first)
    operator = opening_operator(
        np.array(first), np.array(second), np.tile(UPRIGHT, (contacts, 1, 1)), np.array(point), centres
    )
    inertia = mass / 12 * np.array([depth**2 + height**2, length**2 + height**2, length**2 + depth**2])
    inverse = np.tile(np.concatenate([np.full(3, 1 / mass), 1 / inertia]), bodies)
    fall = np.zeros(6 * bodies)
    fall[2::6] = -G * dt
    dense = operator.toarray()
    return (dense * inverse) @ dense.T, dense @ fall


def natural_map(w: np.ndarray, q: np.ndarray, mu: float, r: np.ndarray) -> float:
    """|r - P_K(r - rho (u + mu |u_T| n))| relative, contact by contact, written from the definition."""
    u = (w @ r + q).reshape(-1, 3)
    r, misses, sizes = r.reshape(-1, 3), [], []
    for ua, ra, block in zip(u, r, range(len(r)), strict=True):
        rho = 3.0 / np.trace(w[3 * block : 3 * block + 3, 3 * block : 3 * block + 3])
        x = ra - rho * (ua + [mu * np.hypot(ua[1], ua[2]), 0.0, 0.0])
        force = np.hypot(x[1], x[2])
        if force <= mu * x[0]:
            projected = x
        elif mu * force <= -x[0]:
            projected = np.zeros(3)
        else:
            height = (x[0] + mu * force) / (1 + mu * mu)
            projected = np.array([height, *(mu * height / force * x[1:])])
        misses.append(np.linalg.norm(ra - projected) / rho)
        sizes.append(np.linalg.norm(q[3 * block : 3 * block + 3]))
    return float(np.linalg.norm(misses) / np.linalg.norm(sizes))


@checks
def stacks() -> list[Row]:
    rows = []
    for name, shape, across in (("a wall of four rows of bricks", 4, 4), ("a tower of ten bricks", 10, 1)):
        w, q = wall(shape, across)
        solution = solve_contacts(w, q, 0.6, tolerance=1e-8)
        rows.append(
            Row(
                f"{name}, error of the natural map",
                0.0,
                natural_map(w, q, 0.6, solution.reactions),
                1e-7,
                "de Saxce's form, computed apart",
            )
        )
        ground = solution.reactions[::3][: 4 * across].sum() / (shape * across * 2.0 * G * 1e-3)
        rows.append(Row(f"{name}, force on the ground over its weight", 1.0, ground, 1e-6, "equilibrium"))
    return rows


@checks
def generated() -> Row:
    """Twenty coupled contacts of random masses: the worst of ten problems."""
    worst = 0.0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        jacobian = rng.normal(size=(60, 66))
        q = rng.normal(size=60)
        q[::3] -= 0.5
        w = jacobian @ jacobian.T / 66 + 0.2 * np.eye(60)
        worst = max(worst, natural_map(w, q, 0.7, solve_contacts(w, q, 0.7, tolerance=1e-10).reactions))
    return Row(
        "twenty coupled contacts, error of the natural map",
        0.0,
        worst,
        1e-9,
        "de Saxce's form, computed apart",
    )
