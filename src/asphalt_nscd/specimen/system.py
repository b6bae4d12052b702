"""The mechanical system of a two-point bending test on a specimen."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.specimen.trimming import Specimen

HEADS = ("free", "blocked")


def bending_system(
    specimen: Specimen, poisson: float, yield_stress: float, friction: float, head: str = "free",
    gravity: float = 9.81,
) -> BondedSystem:  # fmt: skip
    """Foot fixed, head driven along x; the head's rotation is "free" or "blocked".

    The head is a plate of the mobile mass with the inertia of a thin rectangle b x e; its other two
    translations are free. Plate bonds do not yield. yield_stress [Pa] acts on pi rmin^2.
    """
    n, geometry, network = specimen.radius.size, specimen.geometry, specimen.network
    ball = specimen.density * 4.0 / 3.0 * np.pi * specimen.radius**3
    mass = np.empty((n + 1, 6))
    mass[:n, :3] = ball[:, None]
    mass[:n, 3:] = (0.4 * ball * specimen.radius**2)[:, None]
    b2, e2 = geometry.b**2, geometry.e**2
    mass[n, :3] = geometry.mobile_mass
    mass[n, 3:] = geometry.mobile_mass / 12.0 * np.array([e2, b2, b2 + e2])
    load = np.zeros((n + 1, 6))
    load[:, 2] = -gravity * mass[:, 2]
    head_position = np.array([[0.0, 0.0, geometry.h]])
    position = np.concatenate([specimen.position, head_position])
    operator = opening_operator(network.first, network.second, network.frame, network.point, position)
    kept = np.arange(6 * (n + 1))
    if head == "blocked":
        kept = kept[:-3]
    share = np.array([1.0, 0.5 / (1.0 + poisson), 0.5 / (1.0 + poisson)])
    strength = yield_stress * network.area
    strength[np.maximum(network.first, network.second) >= n] = np.inf
    return BondedSystem(
        operator=operator[:, kept], weight=(network.form[:, None] * share).ravel(),
        mass=mass.ravel()[kept], load=load.ravel()[kept], driven=6 * n,
        gap=network.gap, strength=strength, friction=friction, position=position,
    )  # fmt: skip
