"""From the layer to the specimen: trim to the trapezoid, turn upright, shrink, weigh, bond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.geometry import require_joined
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.nscd.bonds.system import clusters
from asphalt_nscd.specimen.network import Network, bond_network, facet_network

FEWEST_BONDS = 3
"""Below three bonds a sphere can still move freely: such grains fall out when the layer is cut."""


@dataclass(frozen=True)
class Specimen:
    """Bonded spheres between the foot (z = 0) and the head (z = h); the origin is the middle of the foot.

    `position` (n, 3) and `radius` (n,), after the reduction of volume, in m; `density`, matched to the mass of the
    geometry, in kg/m3. `loose_grains` were removed for fewer than three bonds or no chain to the foot.
    `volume_reduction` is the part of each sphere's volume that it lost.
    """

    geometry: Shape
    position: np.ndarray
    radius: np.ndarray
    density: float
    network: Network
    loose_grains: int
    area: str = "paper"
    volume_reduction: float = 0.0


def layer_height(position: np.ndarray, radius: np.ndarray) -> float:
    """Height of a layer on z = 0 [m], twice that of its centre of mass; `position` (n, 3), `radius` (n,) in m."""
    return float(2.0 * np.average(position[:, 2], weights=radius**3))


def trim(
    position: np.ndarray,
    radius: np.ndarray,
    geometry: Shape,
    volume_reduction: float,
    reach: float,
    area: str = "paper",
) -> Specimen:
    """Cut the specimen from a layer (length along x, width along y, height along z) and bond it.

    From the middle of its height; along its length and width it begins at the walls x = 0 and y = 0.

    `position` (n, 3) and `radius` (n,) in m are of the layer. Grains whose barycentre lies outside the shape are
    removed; each sphere's volume is reduced by the fraction `volume_reduction`; the density is raised until the mass is
    right. Pairs with a gap below `reach` [m] are bonded by area "paper", those that share a facet by "facets".
    """
    require_joined(geometry, area)
    height = layer_height(position, radius)
    # twice the mean of heights may miss those of a lattice by a rounding
    if height < geometry.width * (1.0 - 1e-9):
        raise InputError(
            f"the deposited layer is {1e3 * height:.1f} mm high, less than the foot of the specimen "
            f"({1e3 * geometry.width:.1f} mm); pour more spheres."
        )
    across, along = position[:, 2] - height / 2.0, position[:, 1] - geometry.thickness / 2.0
    # the layer was poured lying: its length is the height of the specimen, its height the width
    upright = np.stack([across, along, position[:, 0]], axis=1)
    normal, offset = geometry.faces()
    inside = (upright @ normal.T <= offset).all(axis=1)
    upright = upright[inside]
    shrunk = radius[inside] * (1.0 - volume_reduction) ** (1.0 / 3.0)
    candidates = shrunk.size
    # a grain that falls out takes bonds from its neighbours, and in facets gives them its cell: until none does
    while True:
        if not shrunk.size:
            raise InputError(
                "no sphere is left after trimming; pour more spheres or raise the bond distance."
            )
        if area == "facets":
            network = facet_network(upright, shrunk, geometry)
        else:
            # the paper's reach is the smallest diameter, which we take before spheres shrink: |E*| is 1.10 of the
            # law; taken after it, 1.93 mm, 1.05
            network = bond_network(upright, shrunk, geometry.h, reach)
        kept, joined = held(network, shrunk.size, len(geometry.plates))
        if kept.all():
            break
        upright, shrunk = upright[kept], shrunk[kept]
    if not joined:
        raise InputError(
            "no chain of bonds joins the foot and the head of the specimen; make the box as long as the "
            f"specimen is high ({1e3 * geometry.h:.1f} mm), pour more spheres or raise the bond distance."
        )
    if network.gap.min() <= 0.0:
        raise InputError(
            f"bodies of the specimen overlap by {-1e3 * network.gap.min():.3g} mm; raise the reduction of "
            f"volume, and make the box as long as the specimen is high ({1e3 * geometry.h:.1f} mm)."
        )
    density = geometry.mass / float((4.0 / 3.0 * np.pi * shrunk**3).sum())
    loose = candidates - shrunk.size
    return Specimen(geometry, upright, shrunk, density, network, loose, area, volume_reduction)


def held(network: Network, n: int, plates: int = 2) -> tuple[np.ndarray, bool]:
    """Whether each of `n` spheres (n,) has FEWEST_BONDS and a chain to the foot; whether bonds join all plates."""
    ends = network.first, network.second
    count = np.bincount(np.concatenate(ends), minlength=n + plates)[:n]
    cluster = clusters(*ends, n + plates)
    joined = bool((cluster[n:] == cluster[n]).all())
    return (count >= FEWEST_BONDS) & (cluster[:n] == cluster[n + 1]), joined
