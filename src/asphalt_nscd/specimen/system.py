"""The mechanical system of a test on a specimen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.shape import DRIVEN, FREE, HELD, Plate, Shape
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.specimen.trimming import Specimen


def affine_modulus(kt_over_kn: float) -> float:
    """E of an isotropic network that fills the volume, over that of its bonds, if all spheres follow the strain.

    (2 + 3 a) / (4 + a) for `kt_over_kn` = a: 1/2 of bonds without tangential stiffness, 1 where both are alike.
    """
    return (2.0 + 3.0 * kt_over_kn) / (4.0 + kt_over_kn)


def affine_poisson(kt_over_kn: float) -> float:
    """Poisson's ratio of a network whose spheres follow the mean strain.

    It goes from 1/4 without tangential stiffness to -1 with no other. Isotropic normals n, spheres that follow the
    strain (Voigt), a = kt/kn and sum(A l) = 3 V give the stiffness C = 3 E < n n n n + a (n n d - n n n n) >, d being
    the unit tensor.
    """
    return (1.0 - kt_over_kn) / (4.0 + kt_over_kn)


def facet_share(shape: Shape, kt_over_kn: float) -> np.ndarray:
    """Stiffnesses (3,) of a facet over E A / l, normal and two tangential, E being the modulus of the law.

    The law is that of |E*| by the form factor of the test. That of two-point bending counts bending alone: the material
    is stiffer by the part that shear has in the deflection. One constant from theory (docs/mapping.md), none from a
    specimen.
    """
    modulus = affine_modulus(kt_over_kn) * shape.counted_share(affine_poisson(kt_over_kn))
    return np.array([1.0, kt_over_kn, kt_over_kn]) / modulus


def inertia(specimen: Specimen) -> np.ndarray:
    """Mass [kg] in three columns, and moment of inertia [kg m2] in three, of each sphere (n, 6).

    Cells that fill the specimen bear its mass as evenly as its stiffness; spheres of one density do not.
    """
    cell = specimen.network.cell
    # masses of cells leave the first resonance of a bar 7e-5 from c/4L, those of spheres 3.7e-3
    if cell.size:
        # turning, it is a sphere as large as its cell
        mass, radius = specimen.geometry.mass * cell / cell.sum(), np.cbrt(0.75 * cell / np.pi)
    else:
        radius = specimen.radius
        mass = specimen.density * 4.0 / 3.0 * np.pi * radius**3
    return np.repeat(np.stack([mass, 0.4 * mass * radius**2], axis=1), 3, axis=1)


def bond_weight(specimen: Specimen, poisson: float, kt_over_kn: float) -> np.ndarray:
    """Stiffness per modulus w [m] of the bonds (b, 3), normal and tangential; see `bending_system`.

    `poisson` is of Eqs. (8)-(11), for area "paper"; `kt_over_kn` is for "facets".
    """
    if specimen.area == "facets":
        stiffness = facet_share(specimen.geometry, kt_over_kn)
    else:
        stiffness = np.array([1.0, 0.5 / (1.0 + poisson), 0.5 / (1.0 + poisson)])  # G over E, Eqs. (8)-(11)
    return specimen.network.form[:, None] * stiffness


def bending_system(
    specimen: Specimen,
    poisson: float,
    yield_stress: float,
    friction: float,
    head: str = "free",
    gravity: float = 9.81,
    kt_over_kn: float = 1.0,
) -> BondedSystem:
    """Bonds and masses of a specimen with plates held, free and driven as its shape says.

    The head is a thin plate of the mobile mass; its other two translations are free, its rotation is "free" or
    "blocked". Plate bonds do not yield. `poisson` is of Eqs. (8)-(11), for area "paper"; `kt_over_kn` is for "facets".
    `yield_stress` acts on the area of a bond [Pa], `friction` where a gap closes; `gravity` in m/s2.
    Refuses a blocked head where the test turns the specimen at its clamps.
    """
    n, geometry, network = specimen.radius.size, specimen.geometry, specimen.network
    plates = [plate for plate in geometry.plates if plate.moves]
    if head == "blocked" and len(plates) > 1:
        raise InputError(f"head: {geometry.test} turns the specimen at its clamps; give free.")
    mass = np.empty((n + len(plates), 6))
    mass[:n] = inertia(specimen)
    mobile = geometry.mobile_mass * np.array([plate.share for plate in plates])
    mass[n:, :3] = mobile[:, None]
    mass[n:, 3:] = mobile[:, None] * geometry.gyration()
    load = np.zeros_like(mass)
    load[:, geometry.down] = -gravity * mass[:, geometry.down]
    centres = np.array([[0.0, 0.0, plate.height] for plate in plates])
    position = np.concatenate([specimen.position, centres])
    operator = opening_operator(network.first, network.second, network.frame, network.point, position)
    column, place = _columns(n, plates, head == "blocked")
    strength = yield_stress * network.area
    strength[np.maximum(network.first, network.second) >= n] = np.inf
    return BondedSystem(
        operator=_joined(operator, column),
        weight=bond_weight(specimen, poisson, kt_over_kn).ravel(),
        # plates that are driven as one share a number: their masses add up
        mass=np.bincount(column[column >= 0], mass.ravel()[column >= 0]),
        load=np.bincount(column[column >= 0], load.ravel()[column >= 0]),
        driven=int(column[6 * n + geometry.axis]),
        gap=network.gap,
        strength=strength,
        friction=friction,
        position=position,
        place=place,
    )


def _columns(n: int, plates: Sequence[Plate], blocked: bool) -> tuple[np.ndarray, np.ndarray]:
    """What becomes of the degrees of freedom of n spheres and the plates that move, six each; blocked: no plate turns.

    Returns column, the number of each in the system, -1 where it is held, the same for all that are driven; and place
    (d,), where each one of the system stands among all.
    """
    motion = np.array([plate.motion for plate in plates])
    if blocked:
        motion[:, 3:] = HELD
    motion = np.concatenate([np.full(6 * n, FREE), motion.ravel()])
    driven = np.flatnonzero(motion == DRIVEN)
    own = motion != HELD
    own[driven[1:]] = False
    column = np.where(own, np.cumsum(own) - 1, -1)
    column[driven] = column[driven[0]]
    return column, np.flatnonzero(own)


def _joined(operator: sparse.csr_matrix, column: np.ndarray) -> sparse.csr_matrix:
    """An operator (rows, all) on the degrees of freedom that are kept."""
    entries = operator.tocoo()
    at = column[entries.col]
    kept = at >= 0
    values = entries.data[kept], (entries.row[kept], at[kept])
    return sparse.csr_matrix(values, shape=(operator.shape[0], int(column.max()) + 1))
