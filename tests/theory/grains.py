"""Grains in a box, and what is measured on them."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice

G = 9.81
R = 2.0**-9  # m; a power of two, so that spheres touch to the last digit


def numerics(**changes) -> PouringNumerics:
    """Solved to rounding; overlaps are never undone, which would add motion that the theory does not know."""
    tight = {"time_step": 1e-4, "tolerance": 1e-14, "most_sweeps": 5000, "recovery_speed": 0.0}
    return PouringNumerics(**tight | changes)


def balls(
    position, radius=R, box=(1.0, 1.0, 1.0), friction=0.5, restitution=0.0, gravity=(0, 0, -G), **law
) -> GranularBed:
    """`law`: of the contacts, beside friction; walls are as rough as spheres unless it says otherwise."""
    position = np.atleast_2d(np.asarray(position, float))
    sizes, contacts = np.broadcast_to(radius, len(position)).astype(float), {"wall_friction": friction} | law
    bed = GranularBed.spheres_in_box(
        position, sizes, box, 2600.0, ContactLaw(friction, **contacts), restitution
    )
    bed.gravity = np.asarray(gravity, float)
    return bed


def advanced(bed: GranularBed, steps: int, settings: PouringNumerics | None = None) -> GranularBed:
    """The bed itself, advanced by `steps`."""
    for _ in range(steps):
        bed.advance(settings or numerics())
    return bed


def mass(bed: GranularBed) -> np.ndarray:
    return 1.0 / bed.inverse_mass[: bed.radius.size]


def pairs(bed: GranularBed):
    """(first, second, impulse on the second) of every listed pair."""
    first = np.repeat(np.arange(bed.radius.size), np.diff(bed._start))
    return zip(first, bed._other, bed.impulse)


def momentum(bed: GranularBed) -> np.ndarray:
    n = bed.radius.size
    return mass(bed) @ bed.velocity[:n, :3]


def angular_momentum(bed: GranularBed) -> np.ndarray:
    """About the origin; a spin s, the velocity of the surface, adds m 2/5 r s."""
    n, m = bed.radius.size, mass(bed)[:, None]
    v, s = bed.velocity[:n, :3], bed.velocity[:n, 3:]
    return (m * np.cross(bed.position, v) + 0.4 * m * bed.radius[:, None] * s).sum(axis=0)


def energy(bed: GranularBed) -> float:
    """Kinetic and potential [J]."""
    return bed.kinetic_energy() - float(mass(bed) @ (bed.position @ bed.gravity))


def deepest(bed: GranularBed) -> float:
    """Largest penetration [m]."""
    return float(-min(bed.contacts(1e-6)[1].min(initial=0.0), 0.0))


def on_incline(slope: float, friction: float) -> GranularBed:
    tilted = (G * np.sin(slope), 0.0, -G * np.cos(slope))
    return advanced(balls([0.1, 0.5, R], friction=friction, gravity=tilted), 200)


def cloud(seed, restitution, friction, **law):
    """30 spheres of two sizes strewn over a narrow box, with random velocities and spins."""
    rng = np.random.default_rng(seed)
    box = (0.017, 0.016, 0.05)  # not a multiple of the diameters: three spheres must not wedge between walls
    position, radius = random_lattice(np.array([3e-3, 5e-3]), np.array([20, 10]), box, rng)
    bed = balls(position, radius, box, friction, restitution, **law)
    bed.velocity[: radius.size] = rng.normal(0, 0.2, (radius.size, 6))
    return bed
