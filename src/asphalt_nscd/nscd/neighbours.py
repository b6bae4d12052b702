"""Candidate pairs of spheres from one cell list.

Each sphere looks for spheres not larger than itself, so that the cells can be as small as the
smallest sphere although diameters spread over a factor of five. Planes are appended to the list
of each sphere as bodies N, N+1, ...
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled


@compiled
def find_pairs(position, radius, plane_point, plane_normal, reach):
    """Pairs whose gap is below `reach` [m].

    position (n, 3) [m], radius (n,) [m]; planes by point (p, 3) [m] and unit normal (p, 3) that
    points to the spheres. Returns (start, other): sphere i is paired with bodies
    other[start[i]:start[i + 1]], ascending; body n + k is plane k. Each pair appears once, under
    its larger sphere (under the lower index when equal).
    """
    n = position.shape[0]
    planes = plane_point.shape[0]
    cell, low, shape = _grid(position, radius, reach)
    first, members = _fill_cells(position, cell, low, shape)
    counts = np.zeros(n + 1, np.int64)
    empty = np.empty(0, np.int64)
    for i in range(n):
        counts[i + 1] = _candidates(
            i, position, radius, reach, cell, low, shape, first, members, empty, 0
        ) + _planes_near(i, position, radius, plane_point, plane_normal, reach, empty, 0)
    start = np.cumsum(counts)
    other = np.empty(start[n], np.int64)
    for i in range(n):
        found = _candidates(i, position, radius, reach, cell, low, shape, first, members, other, start[i])
        other[start[i] : start[i] + found].sort()
        if planes:
            _planes_near(i, position, radius, plane_point, plane_normal, reach, other, start[i] + found)
    return start, other


@compiled
def carry_reactions(old_start, old_other, old_reaction, start, other):
    """Reactions of the old pair list moved to the new one (zero where a pair is new)."""
    reaction = np.zeros((other.shape[0], 3))
    for i in range(start.shape[0] - 1):
        k = old_start[i]
        for c in range(start[i], start[i + 1]):
            while k < old_start[i + 1] and old_other[k] < other[c]:
                k += 1
            if k < old_start[i + 1] and old_other[k] == other[c]:
                reaction[c] = old_reaction[k]
    return reaction


@compiled
def _grid(position, radius, reach):
    cell = 2.0 * radius.min() + reach
    low = np.empty(3)
    shape = np.empty(3, np.int64)
    for k in range(3):
        low[k] = position[:, k].min()
        shape[k] = int((position[:, k].max() - low[k]) / cell) + 1
    return cell, low, shape


@compiled
def _fill_cells(position, cell, low, shape):
    n = position.shape[0]
    index = np.empty(n, np.int64)
    first = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    for i in range(n):
        cx = int((position[i, 0] - low[0]) / cell)
        cy = int((position[i, 1] - low[1]) / cell)
        cz = int((position[i, 2] - low[2]) / cell)
        index[i] = (cz * shape[1] + cy) * shape[0] + cx
        first[index[i] + 1] += 1
    first = np.cumsum(first)
    members = np.empty(n, np.int64)
    cursor = first.copy()
    for i in range(n):
        members[cursor[index[i]]] = i
        cursor[index[i]] += 1
    return first, members


@compiled
def _candidates(i, position, radius, reach, cell, low, shape, first, members, out, offset):
    """Count the partners of sphere i; write them from `offset` on when `out` has room."""
    spread = 2.0 * radius[i] + reach
    lo = np.empty(3, np.int64)
    hi = np.empty(3, np.int64)
    for k in range(3):
        lo[k] = max(0, int(np.floor((position[i, k] - spread - low[k]) / cell)))
        hi[k] = min(shape[k] - 1, int(np.floor((position[i, k] + spread - low[k]) / cell)))
    found = 0
    for cz in range(lo[2], hi[2] + 1):
        for cy in range(lo[1], hi[1] + 1):
            row = (cz * shape[1] + cy) * shape[0]
            for m in range(first[row + lo[0]], first[row + hi[0] + 1]):
                j = members[m]
                if radius[j] > radius[i] or (radius[j] == radius[i] and j <= i):
                    continue
                dx = position[j, 0] - position[i, 0]
                dy = position[j, 1] - position[i, 1]
                dz = position[j, 2] - position[i, 2]
                limit = radius[i] + radius[j] + reach
                if dx * dx + dy * dy + dz * dz < limit * limit:
                    if out.shape[0]:
                        out[offset + found] = j
                    found += 1
    return found


@compiled
def _planes_near(i, position, radius, plane_point, plane_normal, reach, out, offset):
    found = 0
    for k in range(plane_point.shape[0]):
        height = 0.0
        for d in range(3):
            height += (position[i, d] - plane_point[k, d]) * plane_normal[k, d]
        if height - radius[i] < reach:
            if out.shape[0]:
                out[offset + found] = position.shape[0] + k
            found += 1
    return found
