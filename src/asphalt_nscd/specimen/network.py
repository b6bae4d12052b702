"""The bond network of a specimen: which bodies are bonded, where, and how strongly.

Bodies are numbered 0 ... n - 1 for the spheres, then the plates of the shape: n for the head, n + 1 for the fixed foot,
or n to n + 3 for four clamps.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import pairwise

import numpy as np

from asphalt_nscd.measurements.shape import Plate, Shape
from asphalt_nscd.nscd.spheres.neighbours import find_pairs
from asphalt_nscd.specimen.power_diagram import Region, frames, power_diagram


@dataclass(frozen=True)
class Network:
    """Bonds between bodies, one row each, and the volumes that they leave to the spheres.

    `frame` (b, 3, 3) has rows: normal from first to second, two tangents. `point` (b, 3) in m is where the bond acts:
    the middle of the gap, or the centroid of the facet. `gap` and `length` (l0 between barycentres), (b,) in m; `area`
    (b,) in m2 is pi rmin^2 or the facet; `cell` (n,) in m3 the cells of the spheres, (0,) by area "paper".
    """

    first: np.ndarray
    second: np.ndarray
    frame: np.ndarray
    point: np.ndarray
    gap: np.ndarray
    length: np.ndarray
    area: np.ndarray
    cell: np.ndarray

    @property
    def form(self) -> np.ndarray:
        """Stiffness of each bond per modulus, as in Eqs. (30)-(33): g = A / l0 [m], (b,)."""
        return self.area / self.length

    def arrays(self) -> dict[str, np.ndarray]:
        """Fields by name, as they are stored."""
        return {f.name: getattr(self, f.name) for f in fields(self)}


def bond_network(position: np.ndarray, radius: np.ndarray, height: float, reach: float) -> Network:
    """Bond every pair of spheres, and every sphere and end plate, with a gap below `reach` [m], by area "paper".

    `position` (n, 3), z = 0 at the foot, `radius` (n,) and the `height` z of the head in m. The lever arm ends in the
    middle of the gap; for a plate, l0 is the distance from the barycentre to its surface.
    """
    n = radius.size
    no_plane = np.empty((0, 3))
    start, other = find_pairs(position, radius, no_plane, no_plane, reach)
    i, j = np.repeat(np.arange(n), np.diff(start)), other
    apart = position[j] - position[i]
    length = np.linalg.norm(apart, axis=1)
    normal = apart / length[:, None]
    gap = length - radius[i] - radius[j]
    point = position[i] + normal * (radius[i] + gap / 2.0)[:, None]
    rmin = np.minimum(radius[i], radius[j])
    parts = [(i, j, normal, point, gap, length, rmin)]
    for level, plate in ((0.0, n + 1), (height, n)):
        distance = np.abs(position[:, 2] - level)
        k = np.flatnonzero(distance - radius < reach)
        body = np.full(k.size, plate)
        up = np.tile([0.0, 0.0, 1.0], (k.size, 1))
        gap = distance[k] - radius[k]
        middle = position[k].copy()
        middle[:, 2] = level + np.sign(position[k, 2] - level) * gap / 2.0
        ends = (k, body) if plate == n else (body, k)
        parts.append((*ends, up, middle, gap, distance[k], radius[k]))
    first, second, normal, point, gap, length, rmin = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    return Network(first, second, frames(normal), point, gap, length, np.pi * rmin**2, np.empty(0))


def facet_network(position: np.ndarray, radius: np.ndarray, shape: Shape) -> Network:
    """Bond every pair of spheres whose cells share a facet, and every sphere whose cell reaches a plate.

    `position` (n, 3), z = 0 at the foot, and `radius` (n,) in m. If spheres follow a uniform strain eps unturned and kt
    = kn, a bond opens by l eps n and carries E A eps n, the traction of a continuum with the stress E eps. In a closed
    cell sum A n = 0: forces cancel; and sum A (c - x) (x) n = V I (c centroid of a facet, x centre of the sphere):
    torques do too if bonds act at c. Any uniform strain is in equilibrium in any packing: modulus E, Poisson's ratio 0.
    """
    n, plates = radius.size, shape.plates
    order = sorted(range(len(plates)), key=lambda k: plates[k].height)
    between = np.searchsorted([plates[k].height for k in order[1:-1]], position[:, 2])
    parts, cell = [], np.empty(n)
    for number, (below, above) in enumerate(pairwise(order)):
        own = np.flatnonzero(between == number)
        if not own.size:
            continue
        facets = power_diagram(position[own], radius[own], _segment(shape, plates[below], plates[above]))
        cell[own] = facets.cells(position[own])
        bonded = facets.second < own.size + 2  # the other faces are free
        first = own[facets.first[bonded]]
        second = np.append(own, [n + above, n + below])[facets.second[bonded]]
        length = facets.length[bonded]
        # both branches are computed: a plate, which has no radius, must not index one
        gap = length - radius[first] - np.where(second < n, radius[np.minimum(second, n - 1)], 0.0)
        cut = np.isin(second, [n + k for k in order[1:-1]])
        gap[cut] = length[cut]  # a plate in the middle cuts through spheres
        # at the centroid: at mid-gap |E*| would be 5 % too low (docs/mapping.md)
        of_facets = facets.frame[bonded], facets.centroid[bonded], gap, length, facets.area[bonded]
        parts.append((first, second, *of_facets))
    first, second, frame, point, gap, length, area = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    return Network(first, second, frame, point, gap, length, area, cell)


def region_of(shape: Shape) -> Region:
    """The specimen between the planes of head, foot and its free faces, in this order."""
    return Region(*shape.faces(), np.array([0.0, 0.0, shape.h / 2.0]))


def _segment(shape: Shape, below: Plate, above: Plate) -> Region:
    """The part of a specimen between two of its plates: the upper plane, the lower one, then the free faces."""
    normal, offset = shape.faces()
    offset[:2] = above.height, 0.0 - below.height
    return Region(normal, offset, np.array([0.0, 0.0, (below.height + above.height) / 2.0]))
