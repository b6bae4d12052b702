"""The bond network of a specimen: which bodies are bonded, where, and how strongly.

Bodies are numbered 0 ... n - 1 for the spheres, n for the head plate, n + 1 for the fixed foot.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from asphalt_nscd.nscd.spheres.neighbours import find_pairs


@dataclass(frozen=True)
class Network:
    """Bonds between bodies; one row each."""

    first: np.ndarray  # (b,) body
    second: np.ndarray  # (b,) body
    frame: np.ndarray  # (b, 3, 3) rows: normal from first to second, two tangents
    point: np.ndarray  # (b, 3) m, middle of the gap, where the bond acts
    gap: np.ndarray  # (b,) m
    length: np.ndarray  # (b,) m, l0 between the barycentres
    area: np.ndarray  # (b,) m2, pi rmin^2

    @property
    def form(self) -> np.ndarray:
        """g = pi rmin^2 / l0 [m] of Eqs. (30)-(33): stiffness per modulus, (b,)."""
        return self.area / self.length

    def arrays(self) -> dict[str, np.ndarray]:
        """Fields by name, as they are stored."""
        return {f.name: getattr(self, f.name) for f in fields(self)}


def bond_network(position: np.ndarray, radius: np.ndarray, height: float, reach: float) -> Network:
    """Bond every pair of spheres, and every sphere and end plate, whose gap is below `reach` [m].

    position (n, 3) [m] with z = 0 at the foot and z = height [m] at the head; radius (n,) [m].
    The lever arm ends in the middle of the gap; for a plate, l0 is the distance from the barycentre
    to its surface.
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
    return Network(first, second, _frames(normal), point, gap, length, np.pi * rmin**2)


def _frames(normal: np.ndarray) -> np.ndarray:
    """Orthonormal frames (b, 3, 3) whose first rows are the normals."""
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    tangent = np.cross(normal, axis)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    return np.stack([normal, tangent, np.cross(normal, tangent)], axis=1)
