"""The power diagram cell by cell: half-spaces against every other sphere and every face."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection


def cell(i, position, radius, normal, offset):
    """(volume, {neighbour: area}) of the cell of sphere i; neighbours n + k are the faces."""
    n = len(radius)
    others = np.delete(np.arange(n), i)
    apart = position[others] - position[i]
    length = np.linalg.norm(apart, axis=1)
    normals = np.concatenate([apart / length[:, None], normal])
    # of equal power: |x - ci|^2 - ri^2 = |x - cj|^2 - rj^2
    power = (position[others] ** 2).sum(1) - radius[others] ** 2 - (position[i] ** 2).sum() + radius[i] ** 2
    offsets = np.concatenate([power / (2 * length), offset])
    corners = HalfspaceIntersection(np.column_stack([normals, -offsets]), position[i]).intersections
    corners = corners[np.isfinite(corners).all(axis=1)]
    area = {}
    for k, (direction, level) in enumerate(zip(normals, offsets)):
        on = corners[np.abs(corners @ direction - level) < 1e-9]
        if len(on) >= 3:
            across = np.linalg.svd(direction[None])[2][1:]
            try:
                area[int(others[k]) if k < n - 1 else n + k - (n - 1)] = ConvexHull(on @ across.T).volume
            except Exception:  # corners in a line: no facet
                continue
    return ConvexHull(corners).volume, area
