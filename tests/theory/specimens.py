"""Small specimens for verification and tests: beams that need not be poured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from asphalt_nscd.files.store import save
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.law import BondLaw, BondLaws
from asphalt_nscd.nscd.bonds.system import BondedSystem, opening_operator
from asphalt_nscd.specimen.network import bond_network, facet_network
from asphalt_nscd.specimen.trimming import Specimen

# Moduli of Table 3 at 15 degC, viscosities lowered until transients die within two cycles at 40 Hz
# (relaxation times below 3 ms), so that a short test reaches its steady state to 1e-9.
QUICK_LAW = BondLaw(24.3e9, 0.06e9, np.array([48.4e9]), np.array([0.077e9]))


QUICK_LAWS = (
    QUICK_LAW,
    BondLaw(60e9, np.inf, np.array([]), np.array([])),
    BondLaw(20e9, np.inf, np.array([30e9, 90e9]), np.array([0.02e9, 0.09e9])),
)


def mixed(system: BondedSystem, table: tuple[BondLaw, ...] = QUICK_LAWS) -> BondLaws:
    """Laws drawn from `table` for each bond, always the same ones, another along it than across."""
    normal, tangential = np.random.default_rng(3).integers(len(table), size=(2, system.gap.size))
    return BondLaws.of_bonds(table, normal, tangential)


def elastic(modulus: float) -> BondLaw:
    """A law of springs alone of `modulus` [Pa], whose dashpot is infinite."""
    return BondLaw(modulus, np.inf, np.array([]), np.array([]))


def jittered_beam(
    seed: int = 1,
    shape: tuple[int, ...] = (3, 2, 9),
    spacing: float = 4e-3,
    fill: float = 0.42,
    reach: float = 2e-3,
    area: str = "paper",
    test: str = Geometry.test,
) -> Specimen:
    """A prismatic beam of spheres on a cubic lattice, each moved within its cell; bonds as in `trim`.

    `shape` has the cells in each direction, the axis of the beam last; `spacing`, the edge of a cell, and `reach` in m.
    `fill` is the largest radius over the spacing; a sphere stays inside its cell, so that none overlap. `test` is
    two-point or four-point bending.
    """
    rng = np.random.default_rng(seed)
    cells = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3)
    radius = spacing * fill * rng.uniform(0.8, 1.0, len(cells))
    slack = 0.98 * (0.5 * spacing - radius)[:, None]
    position = spacing * (cells + 0.5) + slack * rng.uniform(-1.0, 1.0, cells.shape)
    width, thickness, height = spacing * np.array(shape)
    position -= np.array([width / 2, thickness / 2, 0.0])
    masses = {"mass": 4e-3, "mobile_mass": 2e-3}
    geometry: Shape = Geometry(b=width, B=width, e=thickness, h=height, **masses)
    if test == Beam.test:
        geometry = Beam(h=height, depth=width, breadth=thickness, **masses)
    if area == "facets":
        network = facet_network(position, radius, geometry)
    else:
        network = bond_network(position, radius, height, reach)
    density = geometry.mass / float((4 / 3 * np.pi * radius**3).sum())
    return Specimen(geometry, position, radius, density, network, 0, area)


def as_if_poured(beam: Specimen) -> Specimen:
    """The beam, shrunk so much, as it says, that its two closest grains touched before."""
    network = beam.network
    least = np.min((network.gap / network.length)[network.second < beam.radius.size])
    return replace(beam, volume_reduction=1.0 - (1.0 - least) ** 3)


def save_specimen(path: str | Path, beam: Specimen) -> None:
    """A file as `trim` writes it, of a beam that was not poured."""
    arrays = {"position": beam.position, "radius": beam.radius}
    arrays |= {f"network/{name}": value for name, value in beam.network.arrays().items()}
    attributes = beam.geometry.attributes() | {
        "area": beam.area,
        "density": beam.density,
        "loose_grains": 0,
        "volume_reduction": beam.volume_reduction,
    }
    save(path, "specimen", arrays, attributes)


def system_of(
    rows: ArrayLike,
    weight: ArrayLike,
    mass: ArrayLike,
    driven: int = 0,
    load: ArrayLike = 0.0,
    gap: ArrayLike = 1.0,
    strength: ArrayLike = np.inf,
    friction: float = 0.0,
) -> BondedSystem:
    """A system from dense arrays, or one number each.

    `rows` (3 b, d) give openings of the bonds by the velocities, normal first in each. `weight` (3 b,) in m are form
    factors, `mass` (d,) in kg (of rotations kg m2), `load` (d,) in N (moments N m), `gap` (b,) in m, `strength` (b,) in
    N. `driven` is the prescribed degree of freedom.
    """
    operator = sparse.csr_matrix(np.asarray(rows, float))
    bonds, d = operator.shape[0] // 3, operator.shape[1]
    sizes = (3 * bonds, d, d, bonds, bonds)
    weight, mass, load, gap, strength = (
        np.broadcast_to(value, size).astype(float)
        for value, size in zip((weight, mass, load, gap, strength), sizes)
    )
    return BondedSystem(operator, weight, mass, load, driven, gap, strength, friction)


def chain(bodies: int, weight: float, mass: float, load: float = 0.0) -> BondedSystem:
    """Bodies in a row, each bonded to the next and the last to the wall; the first is driven along it.

    Each has one degree of freedom; `weight` is the form factor of each bond [m], `mass` in kg and `load` [N], along the
    row, are those of each body.
    """
    operator = np.zeros((3 * bodies, bodies))
    for k in range(bodies):
        operator[3 * k, k] = -1.0
        if k + 1 < bodies:
            operator[3 * k, k + 1] = 1.0
    return system_of(operator, weight, mass, driven=0, load=load)


def laminated_beam(geometry: Geometry, slices: int, shear: float) -> BondedSystem:
    """A cantilever of rigid plates, joined by four bonds at each of `slices` middles of slices.

    The normal stiffnesses per modulus have the second moment e B(z)^3/12 of the section there about the axis of
    bending, the tangential ones `shear` times its area. Foot fixed, head plate driven along x and free to rotate. The
    plate below a cut carries the mass of half a slice on either side.
    """
    h, step = geometry.h, geometry.h / slices
    middle = (np.arange(slices) + 0.5) * step
    width = geometry.B + (geometry.b - geometry.B) * middle / h
    corner = np.array([[x, y] for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    point = np.empty((4 * slices, 3))
    # four equal bonds w / sqrt(12) from the axis have the second moment of the section
    point[:, :2] = np.tile(corner, (slices, 1)) * np.repeat(width / np.sqrt(12.0), 4)[:, None]
    point[:, 2] = np.repeat(middle, 4)
    frame = np.tile(np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]), (4 * slices, 1, 1))
    upper = np.repeat(np.arange(slices), 4)
    lower = np.where(upper == 0, slices, upper - 1)
    position = np.zeros((slices, 3))
    position[:, 2] = (np.arange(slices) + 1.0) * step
    operator = opening_operator(lower, upper, frame, point, position)
    area = geometry.e * width / step
    weight = np.repeat(area / 4.0, 4)[:, None] * np.array([1.0, shear, shear])
    height = np.append(position[:-1, 2], h - step / 4.0)
    share = geometry.e * (geometry.B + (geometry.b - geometry.B) * height / h) * step
    share[-1] /= 2.0
    density = geometry.mass / (geometry.e * h * (geometry.B + geometry.b) / 2.0)
    # next to no rotary inertia, which Eq. (1) and Rayleigh's quotient do not know
    mass = np.full((slices, 6), 1e-12)
    mass[:, :3] = density * share[:, None]
    mass[-1, :3] += geometry.mobile_mass
    return system_of(operator.toarray(), weight.ravel(), mass.ravel(), driven=6 * (slices - 1))
