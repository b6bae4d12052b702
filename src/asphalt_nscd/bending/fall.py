"""A specimen taken off its plates, whole or sawn in two, that falls on a floor: its bonds turn with its spheres."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from asphalt_nscd.bending.further_settings import Fall
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.world import Surroundings, World, WorldBonds
from asphalt_nscd.specimen.contents import Content
from asphalt_nscd.specimen.system import bond_weight, inertia
from asphalt_nscd.specimen.trimming import Specimen

PARTS = "kinetic", "springs", "dashpots", "impact", "friction", "fracture", "numerical"
"""Of the account, what the energy set free becomes."""


def released(specimen: Specimen, law: BondLaw, fall: Fall, bonds: Bonds) -> World:
    """The specimen over the floor, at rest, its bonds sawn and its bonds to the plates left out."""
    network, n = specimen.network, specimen.radius.size
    # plates do not fall with the specimen
    inside = np.maximum(network.first, network.second) < n
    between = WorldBonds(
        network.first[inside],
        network.second[inside],
        network.frame[inside],
        network.point[inside],
        bond_weight(specimen, bonds.poisson, bonds.kt_over_kn)[inside].ravel(),
        bonds.yield_Pa * network.area[inside],
    )
    law_of_contacts = ContactLaw(bonds.friction, bonds.friction, fall.rolling_friction)
    floor = Surroundings(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), law_of_contacts)
    made = World(specimen.position, specimen.radius, inertia(specimen), between, law, floor, fall.time_step)
    if made.fragments().any():
        raise InputError(
            "specimen: plates within it hold its parts together; let one fall that has plates at its ends alone."
        )
    below = specimen.position[:, 2] < fall.sawn * specimen.geometry.h
    across = below[between.first] != below[between.second]
    if fall.sawn > 0.0 and not across.any():
        raise InputError(
            f"fall: sawn = {fall.sawn:g} meets no bond of spheres; give a share nearer to the middle."
        )
    made.cut(across)
    turn = Rotation.from_euler("y", fall.tilt, degrees=True)
    made.position, made.rotation = turn.apply(specimen.position), turn * made.rotation
    # the lowest surface, not the lowest centre, hangs at this height
    made.position[:, 2] += fall.height - (made.position[:, 2] - specimen.radius).min()
    return made


def fell(specimen: Specimen, law: BondLaw, fall: Fall = Fall(), bonds: Bonds = Bonds()) -> Content:
    """Let a specimen fall; returns arrays and attributes of the file of the fall.

    Arrays: the account of energy [J] and the largest speed [m/s] at each instant kept, and under frames/ the motion of
    all spheres and bonds, as of a test. Shares among the attributes are of the energy that the fall set free [%].
    """
    world = released(specimen, law, fall, bonds)
    sawn, start = int(world.broken.sum()), world.position.copy()
    kept = set(np.linspace(0, fall.steps, min(fall.frames, fall.steps + 1)).round().astype(int).tolist())
    rows, frames = [_row(world)], [_frame(world, start)]
    for step in range(1, fall.steps + 1):
        try:
            world.advance()
        except ArithmeticError as error:
            raise InputError(f"fall: after {world.time:.4g} s {error}; give a shorter time step.") from None
        if step in kept:
            rows.append(_row(world))
            frames.append(_frame(world, start))
    arrays = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    arrays |= {f"frames/{name}": np.array([frame[name] for frame in frames]) for name in frames[0]}
    arrays |= {
        "frames/time_s": arrays["time_s"],
        "frames/position_m": start,
        "frames/radius_m": world.radius,
        "frames/first": world.bonds.first,
        "frames/second": world.bonds.second,
        "frames/area_m2": world.bonds.strength / bonds.yield_Pa,
        "frames/strength_N": world.bonds.strength,
    }
    return arrays, _told(world, fall, sawn, float(arrays["speed_m_s"][-1]))


def _row(world: World) -> dict[str, float]:
    motion = world.velocity.reshape(-1, 6)[:, :3]
    energies = {f"{name}_J": float(getattr(world.energies, name)) for name in ("load", *PARTS)}
    return {"time_s": world.time, "speed_m_s": float(np.linalg.norm(motion, axis=1).max()), **energies}


def _frame(world: World, start: np.ndarray) -> dict[str, np.ndarray]:
    """Motion of spheres and force of bonds at an instant; displacements are from where the fall began."""
    force = (world.weight * world.sigma).reshape(-1, 3) * [-1.0, 1.0, 1.0]  # tension is positive
    # in single precision: a film needs no more digits, and takes half the room
    return {
        "displacement_m": np.asarray(world.position - start, np.float32),
        "velocity_m_s": np.asarray(world.velocity.reshape(-1, 6)[:, :3], np.float32),
        "fragment": np.asarray(world.fragments(), np.int32),
        "broken": world.broken.copy(),
        "bond_force_N": np.asarray(force, np.float32),
    }


def _told(world: World, fall: Fall, sawn: int, speed: float) -> dict[str, Any]:
    """Attributes of the file: counts, and what became of the energy that the fall set free, in percent."""
    sums = world.energies
    free = -sums.load
    shares = {f"{name}_percent": 100.0 * getattr(sums, name) / free for name in PARTS}
    return {
        "spheres": world.radius.size,
        "bonds": world.broken.size,
        "sawn_bonds": sawn,
        "broken_bonds": int(world.broken.sum()) - sawn,
        "fragments": int(world.fragments().max()) + 1,
        "time_step_s": fall.time_step,
        "duration_s": world.time,
        "speed_m_s": speed,
        "energy_J": free,
        **shares,
        "error_percent": 100.0 * sums.error / free,
    }
