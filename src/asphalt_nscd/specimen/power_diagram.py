"""The power diagram (radical Voronoi, Laguerre) of spheres in a convex region.

The cell of a sphere holds the points whose power |x - c|^2 - r^2 is least with respect to it. Lifted to
(x, |x|^2 - r^2) the spheres have a lower convex hull, whose facets are the vertices of the diagram
(Aurenhammer 1987); Qhull finds it. Each sphere is mirrored at the faces of the region. A point inside has less power
with respect to a sphere than to its image, and a point behind a face more: the cells of the spheres
themselves fill the region, whatever the angles between its faces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from asphalt_nscd.files.errors import InputError

FILLED = (
    1e-9  # cells that miss the volume of the region by less, relatively, were cut by every image they need
)
# of the size of the region: a sphere closer to a face is mirrored from here, not onto itself
ON_A_FACE = 1e-9
NEGLIGIBLE = 1e-6  # of the section of the smaller sphere: a smaller facet is left out

# pairs among the four spheres that meet in a vertex
_EDGES = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])


@dataclass(frozen=True)
class Region:
    """A convex polyhedron, normal . x <= offset for each face.

    `normal` (p, 3) is outward, of unit length; `offset` (p,) in m; `inside` (3,) in m is a point of it.
    """

    normal: np.ndarray
    offset: np.ndarray
    inside: np.ndarray

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        corners = HalfspaceIntersection(
            np.column_stack([self.normal, -self.offset]), self.inside
        ).intersections
        return float(ConvexHull(corners).volume)


@dataclass(frozen=True)
class Facets:
    """Plane polygons between cells, and the parts of the region's faces in each cell; one row each."""

    first: np.ndarray  # (f,) sphere
    second: np.ndarray  # (f,) sphere with a larger number, or the number of spheres + that of a face
    frame: np.ndarray  # (f, 3, 3) rows: normal from first to second, two axes in the facet
    area: np.ndarray  # (f,) m2
    length: np.ndarray  # (f,) m, between the centres; from the centre to the face
    centroid: np.ndarray  # (f, 3) m
    spread: np.ndarray  # (f, 3) m2, second moments about the centroid over the area: uu, vv, uv in the frame

    @property
    def volume(self) -> float:
        """Sum of A l / 3 [m3]: pyramids over the facets with their tips in the centres."""
        return float((self.area * self.length).sum() / 3.0)

    def cells(self, position: np.ndarray) -> np.ndarray:
        """Volume (n,) [m3] of each cell, as pyramids from its sphere's centre `position` (n, 3) [m] over its facets."""
        n, own = len(position), self.second < len(position)
        height = ((self.centroid - position[self.first]) * self.frame[:, 0]).sum(axis=1)
        volume = np.bincount(self.first, self.area * height / 3.0, n)
        return volume + np.bincount(self.second[own], (self.area * (self.length - height) / 3.0)[own], n)


def power_diagram(position: np.ndarray, radius: np.ndarray, region: Region) -> Facets:
    """Facets of the power diagram of spheres in a region, one row each; `position` (n, 3) and `radius` (n,) in m.

    Facets smaller than NEGLIGIBLE of the section of the smaller sphere are left out. Spheres near a face are mirrored,
    then those farther away, until the cells fill the region. Raises InputError where they never do.
    """
    distance = region.offset - position @ region.normal.T
    # far enough that each face mirrors a sphere: the diagram is open where one mirrors none
    volume, within = region.volume, max(2.0 * radius.max(), 1.01 * distance.min(axis=0).max())
    while True:
        facets, kept = _diagram(position, radius, region, distance, within)
        if abs(facets.volume / volume - 1.0) < FILLED:
            return Facets(*(value[kept] for value in vars(facets).values()))
        if within > distance.max():
            raise InputError(
                f"the cells of the spheres fill {facets.volume / volume:.9f} of the specimen, not all: their places or "
                "sizes are too far from those of grains; bond them by area paper."
            )
        within *= 2.0


def _diagram(
    position: np.ndarray, radius: np.ndarray, region: Region, distance: np.ndarray, within: float
) -> tuple[Facets, np.ndarray]:
    """All facets, spheres nearer to a face than `within` [m] being mirrored at it; which (f,) are not negligible."""
    n = radius.size
    sphere, face = np.nonzero(distance < within)
    least = np.maximum(distance[sphere, face], ON_A_FACE * float(distance.max()))
    centre = np.concatenate([position, position[sphere] + 2.0 * least[:, None] * region.normal[face]])
    weight = np.concatenate([radius, radius[sphere]]) ** 2
    middle, size = position.mean(axis=0), float(distance.max())
    # about the middle and of order one: the squares of centres far from zero would lose digits
    vertex, corners = _vertices((centre - middle) / size, weight / size**2)
    vertex = vertex * size + middle

    pair = np.sort(corners[:, _EDGES].reshape(-1, 2), axis=1)
    at = np.repeat(np.arange(len(vertex)), len(_EDGES))
    owner = np.concatenate([np.arange(n), sphere])
    # with the image of another a sphere shares no more than an edge on a face
    wanted = (pair[:, 0] < n) & ((pair[:, 1] < n) | (owner[pair[:, 1]] == pair[:, 0]))
    pair, at = pair[wanted], at[wanted]
    order = np.lexsort((pair[:, 1], pair[:, 0]))
    pair, at = pair[order], at[order]
    start = np.flatnonzero(np.append(True, (pair[1:] != pair[:-1]).any(axis=1)))
    i, j = pair[start].T

    apart = centre[j] - centre[i]
    length = np.linalg.norm(apart, axis=1)
    frame = frames(apart / length[:, None])
    reach = (length**2 + weight[i] - weight[j]) / (2.0 * length)
    foot = centre[i] + frame[:, 0] * reach[:, None]
    count = np.diff(np.append(start, len(at)))
    area, middle, spread = _polygons(
        start,
        np.einsum(
            "cka,ca->ck", np.repeat(frame[:, 1:], count, axis=0), vertex[at] - np.repeat(foot, count, axis=0)
        ),
    )
    own = j < n
    image = np.where(own, 0, j - n)
    facets = Facets(
        first=i,
        second=np.where(own, j, n + face[image]),
        frame=frame,
        area=area,
        length=np.where(own, length, length / 2.0),
        centroid=foot + np.einsum("fk,fka->fa", middle, frame[:, 1:]),
        spread=spread,
    )
    return facets, area > NEGLIGIBLE * np.pi * np.minimum(weight[i], weight[j])


def _vertices(centre: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (v, 3) of the unbounded diagram, and the four spheres (v, 4) that meet in each."""
    hull = ConvexHull(np.column_stack([centre, (centre**2).sum(axis=1) - weight]))
    low = hull.equations[:, 3] < -1e-12  # others look up, or stand upright and belong to unbounded facets
    plane = hull.equations[low]
    return -0.5 * plane[:, :3] / plane[:, 3:4], hull.simplices[low]


def _polygons(start: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Area (f,), centroid (f, 2) and second moments over area (f, 3), uu, vv, uv, of convex polygons.

    Each has the corners point[start[k]:start[k + 1]] in any order. A degenerate one has the mean of its corners as
    its centroid.
    """
    count = np.diff(np.append(start, len(point)))
    row = np.repeat(np.arange(start.size), count)
    mean = np.add.reduceat(point, start) / count[:, None]
    u, v = (point - mean[row]).T
    order = np.lexsort((np.arctan2(v, u), row))
    u, v = u[order], v[order]
    after = np.arange(len(point)) + 1
    after[start + count - 1] = start
    p, q = u[after], v[after]
    cross = u * q - p * v

    def total(part: np.ndarray) -> np.ndarray:
        return np.add.reduceat(cross * part, start)

    area = total(np.ones_like(u)) / 2.0
    scale = np.divide(1.0, area, out=np.zeros_like(area), where=area > 0.0)[:, None]
    centroid = np.column_stack([total(u + p), total(v + q)]) * scale / 6.0
    spread = np.column_stack(
        [
            total(u * u + u * p + p * p) / 12.0,
            total(v * v + v * q + q * q) / 12.0,
            total(2.0 * (u * v + p * q) + u * q + p * v) / 24.0,
        ]
    )
    cu, cv = centroid.T
    spread = spread * scale - np.column_stack([cu**2, cv**2, cu * cv])
    return area, mean + centroid, spread


def frames(normal: np.ndarray) -> np.ndarray:
    """Orthonormal frames (b, 3, 3) whose first rows are the unit vectors `normal` (b, 3)."""
    # the axis least along the normal: their cross product is never small
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    tangent = np.cross(normal, axis)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    return np.stack([normal, tangent, np.cross(normal, tangent)], axis=1)
