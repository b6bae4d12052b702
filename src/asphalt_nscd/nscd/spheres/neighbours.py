"""Candidate pairs of spheres from one cell list.

Each sphere looks for spheres not larger than itself, so that the cells can be as small as a few of the
smallest spheres although diameters spread over a factor of five. Planes are appended to the list
of each sphere as bodies N, N+1, ...
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from asphalt_nscd.nscd.compiled import compiled, compiled_for_teams
from asphalt_nscd.nscd.lanes import WIDTH, broadcast, greater_bits, load
from asphalt_nscd.nscd.team import Team, mark_started, partition

CELL = 2.0  # width of cells, in smallest diameters and reaches: eight spheres are looked at together
MOST_CELLS = 2**25  # 128 MB
FAR = 1e100  # m
PARTS = 8  # of the spheres for each member of a team, dealt in turns


class Reach(NamedTuple):
    """Gaps [m] below which a pair is listed."""

    sphere: np.ndarray  # (n,) of the larger sphere of a pair
    extra: np.ndarray  # (n,) on top of it, of both spheres, and of the sphere at a plane
    plane: np.ndarray  # (p,)


def find_pairs(position, radius, plane_point, plane_normal, reach):
    """Pairs (start (n + 1,), other) whose gap is below `reach` [m], by one thread; see `find_pairs_within`."""
    n, planes = position.shape[0], plane_point.shape[0]
    everywhere = Reach(np.full(n, reach), np.zeros(n), np.full(planes, reach))
    return find_pairs_within(Team(), position, radius, plane_point, plane_normal, everywhere, n)


def find_pairs_within(team, position, radius, plane_point, plane_normal, reach, first_plane):
    """Pairs (start (n + 1,), other) whose gap is within their Reach, searched by a team.

    Sphere i is paired with bodies other[start[i]:start[i + 1]], ascending; body first_plane + k is plane k. Each pair
    appears once, under its larger sphere (under the lower index when equal). Lengths in m.
    """
    if position.shape[0] == 0:
        return np.zeros(1, np.int64), np.empty(0, np.int64)
    cells = _fill_cells(position, radius, reach.sphere, reach.extra)
    work = ((2.0 * radius + reach.sphere + reach.extra.max()) ** 3).cumsum()  # volume that is looked through
    parts = PARTS * team.members
    inner = np.searchsorted(work, work[-1] / parts * np.arange(1, parts))
    bounds = np.array([0, *inner, radius.size])
    count = np.empty(radius.size, np.int64)
    planes = plane_point, plane_normal, reach.plane, first_plane
    found = team.run(_partners, bounds, count, (position, radius), planes, reach.sphere, reach.extra, cells)
    start = np.concatenate([[0], count]).cumsum()
    pieces, taken = [], [0] * team.members
    for part, size in enumerate(np.diff(start[bounds]).tolist()):
        rank = part % team.members
        pieces.append(found[rank][taken[rank] : taken[rank] + size])
        taken[rank] += size
    return start, np.concatenate(pieces)


@compiled_for_teams
def _partners(rank, members, barrier, bounds, count, spheres, planes, reach, extra, cells):
    """Count the bodies that each sphere is paired with; returns which, for the parts of a member one after another.

    Part k lies from its bound to the next, and is that of member k % members: the first spheres in a rain have landed
    and lie dense, the last ones still fall.
    """
    mark_started(barrier)
    furthest = extra.max()
    other = np.empty(16 * (spheres[1].shape[0] // members) + 64, np.int64)
    end = 0
    for part in range(rank, bounds.shape[0] - 1, members):
        for i in range(bounds[part], bounds[part + 1]):
            while True:
                found = _candidates(i, spheres, reach[i] + extra[i], furthest, cells, other, end)
                needed = end + found + planes[0].shape[0]
                if needed <= other.shape[0]:
                    break
                # what found no room was counted all the same: grown once, it fits
                other = np.concatenate((other, np.empty(max(needed, other.shape[0]), np.int64)))
            # ascending, so that reactions are carried from list to list in one pass
            _sort(other, end, end + found)
            found += _planes_near(i, spheres, planes, extra[i], other, end + found)
            count[i] = found
            end += found
    return other[:end]


def closing_speeds(team, position, radius, velocity, reach):
    """Bounds (n,) [m/s] of the speeds at which each sphere and its neighbours within `reach` [m] may close in.

    Only spheres that are not larger count, as in find_pairs. The bound is the range of velocities, the sphere's own
    among them, in thin horizontal slabs: grains that rain at the same speed, or rest together, do not close in. The
    sphere's own speed alone is no bound: an impact may stop it, or hand on its speed, within the step.
    """
    bound = np.empty(position.shape[0])
    by_height = _speeds_by_height(position, radius, velocity)
    team.run(_bound_speeds, position, radius, velocity, reach, *by_height, bound)
    return bound


@compiled
def _speeds_by_height(position, radius, velocity):
    """(bottom [m], thickness [m], least (slabs, 3), most (slabs, 3)): velocities of the spheres in horizontal slabs."""
    thickness = 2.0 * radius.min()
    bottom = position[:, 2].min()
    slabs = int((position[:, 2].max() - bottom) / thickness) + 1
    least = np.full((slabs, 3), np.inf)
    most = np.full((slabs, 3), -np.inf)
    for i in range(position.shape[0]):
        s = int((position[i, 2] - bottom) / thickness)
        for k in range(3):
            least[s, k] = min(least[s, k], velocity[i, k])
            most[s, k] = max(most[s, k], velocity[i, k])
    return bottom, thickness, least, most


@compiled_for_teams
def _bound_speeds(
    rank, members, barrier, position, radius, velocity, reach, bottom, thickness, least, most, bound
):
    """Write the bounds of `closing_speeds` for the share of a member."""
    mark_started(barrier)
    begin, end = partition(rank, members, position.shape[0])
    for i in range(begin, end):
        away = 2.0 * radius[i] + reach
        first = max(0, int(np.floor((position[i, 2] - away - bottom) / thickness)))
        last = min(least.shape[0] - 1, int(np.floor((position[i, 2] + away - bottom) / thickness)))
        square = 0.0
        for k in range(3):
            slowest, fastest = velocity[i, k], velocity[i, k]
            for s in range(first, last + 1):
                slowest = min(slowest, least[s, k])
                fastest = max(fastest, most[s, k])
            square += (fastest - slowest) ** 2
        bound[i] = np.sqrt(square)


@compiled
def speeds(velocity):
    """Speeds (n,) [m/s] of spheres whose velocities (n, 3 or more) are in m/s."""
    found = np.empty(velocity.shape[0])
    for i in range(found.shape[0]):
        found[i] = np.sqrt(velocity[i, 0] ** 2 + velocity[i, 1] ** 2 + velocity[i, 2] ** 2)
    return found


@compiled
def moved_beyond(position, before, allowed):
    """How far [m], not below zero, any sphere has moved from `before` (m, 3) [m] beyond its `allowed` (m,) [m]."""
    furthest = 0.0
    for i in range(before.shape[0]):
        x, y, z = position[i, 0] - before[i, 0], position[i, 1] - before[i, 1], position[i, 2] - before[i, 2]
        furthest = max(furthest, np.sqrt(x**2 + y**2 + z**2) - allowed[i])
    return furthest


def carry_reactions(team, old_start, old_other, old_reaction, start, other):
    """Reactions (pairs, 3) [N s] of the old list moved to the new one, zero where new; spheres may join."""
    reaction = np.empty((other.shape[0], 3))
    team.run(_carry, old_start, old_other, old_reaction, start, other, reaction)
    return reaction


@compiled_for_teams
def _carry(rank, members, barrier, old_start, old_other, old_reaction, start, other, reaction):
    """Carry reactions to the share of a member in the new list; both lists ascend, so that one pass finds all."""
    mark_started(barrier)
    first, last_pair = partition(rank, members, other.shape[0])
    spheres = start.shape[0] - 1
    begin = np.searchsorted(start[:spheres], first)
    end = np.searchsorted(start[:spheres], last_pair) if rank < members - 1 else spheres
    for i in range(begin, end):
        k, last = 0, 0
        if i < old_start.shape[0] - 1:
            k, last = old_start[i], old_start[i + 1]
        for c in range(start[i], start[i + 1]):
            while k < last and old_other[k] < other[c]:
                k += 1
            known = k < last and old_other[k] == other[c]
            for d in range(3):
                reaction[c, d] = old_reaction[k, d] if known else 0.0


@compiled_for_teams
def _fill_cells(position, radius, reach, extra):
    """(cell, low, shape, first, members, spheres): width [m], origin and number of the cells.

    Cell k holds members[first[k]:first[k + 1]], in blocks of eight: spheres (b, 6, 8) x, y, z, radius, extra, index.
    A row of cells along x begins with a block; -1 and infinitely far where lanes are left over.
    """
    cell = CELL * (2.0 * radius.min() + reach.min())
    low, extent = np.empty(3), np.empty(3)
    for k in range(3):
        low[k] = position[:, k].min()
        extent[k] = position[:, k].max() - low[k]
    # a speck of dust among boulders would call for more cells than memory holds
    while (extent[0] / cell + 1.0) * (extent[1] / cell + 1.0) * (extent[2] / cell + 1.0) > MOST_CELLS:
        cell *= 2.0
    shape = (extent / cell).astype(np.int64) + 1
    n, rows = position.shape[0], shape[1] * shape[2]
    index = np.empty(n, np.int32)
    first = np.zeros(shape[0] * rows + 1, np.int32)
    for i in range(n):
        cx = int((position[i, 0] - low[0]) / cell)
        cy = int((position[i, 1] - low[1]) / cell)
        cz = int((position[i, 2] - low[2]) / cell)
        index[i] = (cz * shape[1] + cy) * shape[0] + cx
        first[index[i]] += 1
    filled = 0
    for row in range(rows):
        filled = -(-filled // WIDTH) * WIDTH
        for k in range(row * shape[0], (row + 1) * shape[0]):
            filled += first[k]
            first[k] = filled
    blocks = -(-filled // WIDTH)
    first[rows * shape[0]] = WIDTH * blocks
    members = np.full(WIDTH * blocks, -1, np.int64)
    spheres = np.empty((blocks, 6, WIDTH))  # in the order of the cells: read in one stream
    spheres[:, :3] = FAR
    spheres[:, 3:] = 0.0
    # from the last sphere, so that each cell holds its own in ascending order
    for i in range(n - 1, -1, -1):
        first[index[i]] -= 1
        at = first[index[i]]
        members[at] = i
        block, lane = at // WIDTH, at % WIDTH
        for k in range(3):
            spheres[block, k, lane] = position[i, k]
        spheres[block, 3, lane], spheres[block, 4, lane], spheres[block, 5, lane] = radius[i], extra[i], i
    return cell, low, shape, first, members, spheres


@compiled_for_teams
def _cells_between(start, end, cell, cells):
    return max(0, int(np.floor(start / cell))), min(cells - 1, int(np.floor(end / cell)))


@compiled_for_teams
def _candidates(i, centres, reach, furthest, cells, out, offset):
    """Count the partners of sphere i; write them from `offset` on as far as `out` has room."""
    position, radius = centres
    cell, low, shape, first, members, spheres = cells
    x, y, z, size = position[i, 0], position[i, 1], position[i, 2], radius[i]
    # no partner is larger than the sphere itself: two of its radii reach every centre
    spread = 2.0 * size + reach + furthest
    x_first, x_last = _cells_between(x - spread - low[0], x + spread - low[0], cell, shape[0])
    y_first, y_last = _cells_between(y - spread - low[1], y + spread - low[1], cell, shape[1])
    z_first, z_last = _cells_between(z - spread - low[2], z + spread - low[2], cell, shape[2])
    own, number, near = broadcast(size), broadcast(float(i)), broadcast(reach)
    at_x, at_y, at_z = broadcast(x), broadcast(y), broadcast(z)
    found = 0
    for cz in range(z_first, z_last + 1):
        for cy in range(y_first, y_last + 1):
            row = (cz * shape[1] + cy) * shape[0]
            begin, end = first[row + x_first], first[row + x_last + 1]
            # cells of a row lie side by side: one run of blocks, whose ends may hold spheres too far away
            for block in range(begin // WIDTH, -(-end // WIDTH)):
                dx, dy = load(spheres, block, 0) - at_x, load(spheres, block, 1) - at_y
                dz = load(spheres, block, 2) - at_z
                other = load(spheres, block, 3)
                limit = own + other + near + load(spheres, block, 4)
                inside = greater_bits(limit * limit, dx * dx + dy * dy + dz * dz)
                later = greater_bits(load(spheres, block, 5), number) & ~greater_bits(other, own)
                partners = inside & (greater_bits(own, other) | later)
                if partners:
                    for lane in range(WIDTH):  # what is written stays if it counts: no branch hard to foresee
                        if offset + found < out.shape[0]:
                            out[offset + found] = members[WIDTH * block + lane]
                        found += partners >> lane & 1
    return found


@compiled_for_teams
def _sort(numbers, begin, end):
    """Sort in place, by insertion, which is fastest for the few partners of a sphere."""
    for k in range(begin + 1, end):
        number = numbers[k]
        m = k
        while m > begin and numbers[m - 1] > number:
            numbers[m] = numbers[m - 1]
            m -= 1
        numbers[m] = number


@compiled_for_teams
def _planes_near(i, spheres, planes, extra, out, offset):
    """Count the planes near sphere i and write them from `offset` on."""
    (position, radius), found = spheres, 0
    plane_point, plane_normal, reach, first_plane = planes
    for k in range(plane_point.shape[0]):
        height = 0.0
        for d in range(3):
            height += (position[i, d] - plane_point[k, d]) * plane_normal[k, d]
        if height - radius[i] < reach[k] + extra:
            out[offset + found] = first_plane + k
            found += 1
    return found
