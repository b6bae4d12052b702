"""The mechanical system of a test on a specimen."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.specimen.trimming import Specimen

HEADS = ("free", "blocked")


def affine_modulus(kt_over_kn: float) -> float:
    """E of an isotropic network that fills the volume, over that of its bonds, where all spheres follow the strain."""
    return (2.0 + 3.0 * kt_over_kn) / (4.0 + kt_over_kn)


def affine_poisson(kt_over_kn: float) -> float:
    """Poisson's ratio of that network: from 1/4 without tangential stiffness to -1 with no other."""
    return (1.0 - kt_over_kn) / (4.0 + kt_over_kn)


def facet_share(shape: Shape, kt_over_kn: float) -> np.ndarray:
    """Normal and two tangential stiffnesses (3,) of a facet over E A / l, E being the modulus of the law.

    The law is that of |E*| by the form factor of the test. That of two-point bending counts bending alone: the material
    is stiffer by the part that shear has in the deflection. One constant from theory (docs/mapping.md), none from a
    specimen.
    """
    modulus = affine_modulus(kt_over_kn) * shape.counted_share(affine_poisson(kt_over_kn))
    return np.array([1.0, kt_over_kn, kt_over_kn]) / modulus


def _inertia(specimen: Specimen) -> tuple[np.ndarray, np.ndarray]:
    """Mass (n,) [kg] that moves with each sphere, and radius (n,) [m] of a ball of its moment of inertia.

    Cells that fill the specimen bear its mass as evenly as its stiffness; spheres of one density do not.
    """
    cell = specimen.network.cell
    if not cell.size:
        return specimen.density * 4.0 / 3.0 * np.pi * specimen.radius**3, specimen.radius
    return specimen.geometry.mass * cell / cell.sum(), np.cbrt(0.75 * cell / np.pi)


def bending_system(
    specimen: Specimen,
    poisson: float,
    yield_stress: float,
    friction: float,
    head: str = "free",
    gravity: float = 9.81,
    kt_over_kn: float = 1.0,
) -> BondedSystem:
    """Foot fixed, head driven along the axis of its shape; the head's rotation is "free" or "blocked".

    The head is a thin plate of the mobile mass; its other two translations are free. Plate bonds do not yield.
    yield_stress [Pa] acts on the area of a bond. poisson is that of Eqs. (8)-(11) for bonds of area "paper", kt_over_kn
    that of "facets".
    """
    n, geometry, network = specimen.radius.size, specimen.geometry, specimen.network
    share, size = _inertia(specimen)
    mass = np.empty((n + 1, 6))
    mass[:n, :3] = share[:, None]
    mass[:n, 3:] = (0.4 * share * size**2)[:, None]
    mass[n, :3] = geometry.mobile_mass
    mass[n, 3:] = geometry.mobile_mass * geometry.gyration()
    load = np.zeros((n + 1, 6))
    load[:, 2] = -gravity * mass[:, 2]
    head_position = np.array([[0.0, 0.0, geometry.h]])
    position = np.concatenate([specimen.position, head_position])
    operator = opening_operator(network.first, network.second, network.frame, network.point, position)
    kept = np.arange(6 * (n + 1))
    if head == "blocked":
        kept = kept[:-3]
    if specimen.area == "facets":
        stiffness = facet_share(geometry, kt_over_kn)
    else:
        stiffness = np.array([1.0, 0.5 / (1.0 + poisson), 0.5 / (1.0 + poisson)])
    strength = yield_stress * network.area
    strength[np.maximum(network.first, network.second) >= n] = np.inf
    return BondedSystem(
        operator=operator[:, kept],
        weight=(network.form[:, None] * stiffness).ravel(),
        mass=mass.ravel()[kept],
        load=load.ravel()[kept],
        driven=6 * n + geometry.axis,
        gap=network.gap,
        strength=strength,
        friction=friction,
        position=position,
    )
