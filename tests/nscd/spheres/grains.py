"""Grains in a box, and what is measured on them."""

from __future__ import annotations

import numpy as np

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


def cloud(seed, restitution, friction):
    """30 spheres of two sizes strewn over a narrow box, with random velocities and spins."""
    rng = np.random.default_rng(seed)
    box = (0.017, 0.016, 0.05)  # not a multiple of the diameters: three spheres must not wedge between walls
    position, radius = random_lattice(np.array([3e-3, 5e-3]), np.array([20, 10]), box, rng)
    granulate = balls(position, radius, box, friction, restitution)
    granulate.velocity[: radius.size] = rng.normal(0, 0.2, (radius.size, 6))
    return granulate
