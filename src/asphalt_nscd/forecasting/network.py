"""The network of a level: grains of a packing, films of matrix between them, and its static modulus."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from asphalt_nscd.forecasting.film import Films, Matrix, Solid, film_stiffness
from asphalt_nscd.forecasting.levels import Level
from asphalt_nscd.forecasting.packing import LARGEST, LevelPacking
from asphalt_nscd.forecasting.static_map import RATIOS, StaticMap, fit_map
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.statics import Statics
from asphalt_nscd.specimen.network import facet_network
from asphalt_nscd.specimen.prism import cut_prism, pulled_system, stretched
from asphalt_nscd.specimen.trimming import Specimen, layer_height

SKIN = 0.6  # largest grains, cut off from each side of the layer
POINTS = 200_000  # thrown into the prism to find its solid fraction, to 0.1 % of the volume
CONTACT = 0.01  # of the smaller radius: a smaller gap in the poured layer is a contact
THINNEST = 1e-5  # film over the distance of the centres; a sphere cut by a plate has none
ABSENT = 1e-6  # of its stiffness: a film that is a void
NEIGHBOURS = 3  # ratios that share factors, made at the middle one
TOLERANCE = 1e-10  # of the static solutions
MOST_ITERATIONS = 25  # of one with the factors of a neighbour, or of another map


@dataclass(frozen=True)
class Physics:
    """What films and contacts do; each can be taken away (docs/forecast.md).

    `film` [m] is the matrix between grains that touch, None keeps grains apart as the fraction says; `loosening` widens
    these films, a linear strain; `void_share` of the facets are without film; `skeleton_pressure` [Pa] presses dry
    contacts together. Not `squeezed`: Poisson's ratio of a film is zero, instead of a nearly incompressible matrix, and
    lines through grain and film do not know of each other.
    """

    film: float | None = None
    loosening: float = 0.0
    void_share: float = 0.0
    skeleton_pressure: float = 0.0
    squeezed: bool = True


@dataclass(frozen=True, eq=False)
class Contents:
    """A prism of a level's packing, spheres at their own size, and the fraction of its volume that they fill."""

    prism: Specimen
    solid_fraction: float


def contents_of(packing: LevelPacking) -> Contents:
    """The prism cut from the middle of a layer, with its solid fraction."""
    position, radius, margin = packing.position, packing.radius, SKIN * LARGEST
    top = layer_height(position, radius)
    length, width = packing.box[:2] - 2.0 * margin
    geometry = Geometry(
        b=top - 2.0 * margin, B=top - 2.0 * margin, e=width, h=length, mass=1.0, mobile_mass=1.0
    )
    corner = np.full(3, margin)
    prism = cut_prism(position, radius, corner, geometry, lambda at, r: facet_network(at, r, geometry))
    size = np.array([geometry.h, geometry.e, geometry.b])
    # One seed: the same packing has the same solid fraction in each run.
    point = corner + np.random.default_rng(0).random((POINTS, 3)) * size
    inside = np.zeros(POINTS, bool)
    for held in cKDTree(point).query_ball_point(position, radius):
        inside[held] = True
    return Contents(prism, float(inside.mean()))


def films_of(contents: Contents, level: Level, physics: Physics) -> tuple[Films, np.ndarray]:
    """Films at the level's fraction, in packing units, and which of them lie between grains that touch (b,).

    Spheres shrink alike until they fill the fraction; grains that touched in the layer, never at a plate, stay as close
    as `physics.film` says: a crushed grain holds less than the sphere that touches the same neighbours. Radii of a film
    come larger first.
    """
    prism, network = contents.prism, contents.prism.network
    radius = np.append(prism.radius, [0.0, 0.0])  # the plates
    own = radius[np.minimum(network.first, prism.radius.size)]
    other = radius[np.minimum(network.second, prism.radius.size)]
    length = network.length
    between = (own > 0.0) & (other > 0.0)
    touching = between & (network.gap < CONTACT * np.minimum(own, other))
    shrunk = min(1.0, (level.fraction / contents.solid_fraction) ** (1.0 / 3.0))
    gap = length - shrunk * (own + other)
    if physics.film is not None:
        film = physics.film * LARGEST / level.largest + physics.loosening * length
        gap = np.where(touching, np.minimum(film, gap), gap)
    gap = np.maximum(gap, THINNEST * length)
    scale = (length - gap) / (own + other)
    one, two = own * scale, other * scale
    return Films(np.maximum(one, two), np.minimum(one, two), gap, network.area), touching


def level_map(
    contents: Contents, level: Level, grain: Solid, matrix_bulk: float, physics: Physics
) -> StaticMap:
    """Young's modulus of a level over that of its grains as a function of that of its matrix, likewise.

    `matrix_bulk` is K of the matrix [Pa].
    """
    stiffness = bond_stiffness(contents, level, grain, matrix_bulk, physics, RATIOS) / grain.modulus
    found = np.empty(RATIOS.size)
    for statics, group in zip(
        _statics(contents), np.arange(RATIOS.size).reshape(-1, NEIGHBOURS), strict=True
    ):
        # the middle one first: its factors serve the ratios on both sides
        for k in np.roll(group, -(NEIGHBOURS // 2)):
            system = replace(statics.system, weight=stiffness[k])
            found[k] = stretched(contents.prism, system, statics.motion(stiffness[k]))[0]
    return fit_map(found)


@lru_cache(maxsize=4)  # the levels of a mix: factors of more would fill the memory
def _statics(contents: Contents) -> list[Statics]:
    """One for each group of neighbours among RATIOS. Factors serve all maps of a network: films change, not bonds."""
    system = pulled_system(contents.prism, np.zeros(3 * contents.prism.network.first.size))
    return [
        Statics(system, TOLERANCE, MOST_ITERATIONS, MOST_ITERATIONS) for _ in range(RATIOS.size // NEIGHBOURS)
    ]


def bond_stiffness(
    contents: Contents, level: Level, grain: Solid, matrix_bulk: float, physics: Physics, ratio: np.ndarray
) -> np.ndarray:
    """Normal and two tangential stiffnesses (m, 3 b) [N/m] of all bonds: films, those that are voids, dry contacts.

    `ratio` (m,) is the modulus of the matrix over that of the grains, real or complex. At a ratio of one the matrix is
    the material of the grains, where films are squeezed: its bulk modulus rises with the modulus from `matrix_bulk`, K
    where it is soft [Pa], to theirs.
    """
    films, touching = films_of(contents, level, physics)
    young = ratio * grain.modulus
    bulk = matrix_bulk + ratio * (grain.bulk - matrix_bulk) if physics.squeezed else young / 3.0
    normal, tangential = film_stiffness(films, grain, Matrix(young, bulk), level.fraction)
    present = np.ones(films.gap.size)
    present[_voids(films.area, physics.void_share)] = ABSENT
    dry = touching * _dry_contact(contents, touching, grain, physics.skeleton_pressure)
    sliding = 2.0 * (1.0 - grain.poisson) / (2.0 - grain.poisson)  # Mindlin, stuck
    one, two = present * normal + dry, present * tangential + sliding * dry
    return np.stack([one, two, two], axis=-1).reshape(len(young), -1)


def _voids(area: np.ndarray, share: float) -> np.ndarray:
    """Facets drawn at random until they make up a share of the area."""
    # the same facets at every share: between two mixes only the mix differs
    order = np.random.default_rng(0).permutation(area.size)
    return order[np.cumsum(area[order]) < share * area.sum()]


def _dry_contact(contents: Contents, touching: np.ndarray, grain: Solid, pressure: float) -> float:
    """Normal stiffness [N/m] of a Hertz contact where equal forces in all contacts carry a pressure [Pa].

    Love and Weber: p = sum F l / (3 V). Mean radius of curvature; stiffness 2 E' a with a^3 = 3 F R / (4 E').
    """
    if not pressure:
        return 0.0
    prism = contents.prism
    volume = prism.geometry.width * prism.geometry.thickness * prism.geometry.h
    force = 3.0 * pressure * volume / prism.network.length[touching].sum()
    plane = grain.modulus / (2.0 * (1.0 - grain.poisson**2))
    curvature = 0.5 * float(np.average(prism.radius, weights=prism.radius**2))
    return 2.0 * plane * float(np.cbrt(0.75 * force * curvature / plane))
