"""Rigid spheres and planes with Signorini-Coulomb contacts: one NSCD step.

Moreau-Jean time stepping with impulses (Eq. 14). The nonlinear Gauss-Seidel method visits the
contacts one by one; for spheres the local Delassus operator is diagonal in the contact frame, so
the local problem is solved exactly without ever building tangent vectors (gauss_seidel.py).

Spin is stored as surface velocity s = radius * angular velocity [m/s]: both bodies then enter the
contact in the same way, U = v_j - v_i - (s_i + s_j) x n, and m (2/5) s' = -n x r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from asphalt_nscd.nscd.compiled import compiled, compiled_for_teams
from asphalt_nscd.nscd.lanes import (
    WIDTH,
    broadcast,
    gather,
    largest,
    load,
    select_greater,
    sqrt,
    store,
    total,
    zeros,
)
from asphalt_nscd.nscd.spheres.gauss_seidel import COUNT, DEEPEST, sweep_until
from asphalt_nscd.nscd.spheres.laws import FORCE
from asphalt_nscd.nscd.spheres.slabs import first_and_end, private_rows
from asphalt_nscd.nscd.team import barrier_wait, mark_started, partition

OUT_OF_REACH = 1e30  # m or m/s


class StepNumerics(NamedTuple):
    """How a step of `dt` [s] is made.

    A gap below `margin` [m] is a contact. Overlaps beyond `allowed_overlap` [m] are undone no faster than by
    `recovery_speed` [m/s]; zero: never. A step may add `penetration` [m] to an overlap; the rest is `sweep_until`'s.
    """

    dt: float
    recovery_speed: float
    allowed_overlap: float
    margin: float
    tolerance: float
    penetration: float
    enough_sweeps: int
    most_sweeps: int


@compiled_for_teams
def normal_and_gap(i, j, position, radius, plane_point, plane_normal):
    """(x, y, z, gap): unit normal from body i to body j, and their gap [m], below zero where they overlap.

    `j` is a sphere, or from n on plane j - n, whose given normal points to the spheres. Spheres in one place part
    along z.
    """
    n = position.shape[0]
    if j < n:
        x = position[j, 0] - position[i, 0]
        y = position[j, 1] - position[i, 1]
        z = position[j, 2] - position[i, 2]
        distance = np.sqrt(x * x + y * y + z * z)
        if (
            distance == 0.0
        ):  # any normal parts two spheres in one place; not none, which would leave them there
            return 0.0, 0.0, 1.0, -radius[i] - radius[j]
        return x / distance, y / distance, z / distance, distance - radius[i] - radius[j]
    x, y, z = plane_normal[j - n]
    gap = -radius[i]
    gap += (position[i, 0] - plane_point[j - n, 0]) * x
    gap += (position[i, 1] - plane_point[j - n, 1]) * y
    gap += (position[i, 2] - plane_point[j - n, 2]) * z
    return -x, -y, -z, gap


@compiled
def near_pairs(position, radius, plane_point, plane_normal, start, other, below):
    """First bodies, second bodies and gaps [m] (c,) of those listed pairs whose gap is less than `below` [m]."""
    total = other.shape[0]
    first = np.empty(total, np.int64)
    second = np.empty(total, np.int64)
    gaps = np.empty(total)
    count = 0
    for i in range(start.shape[0] - 1):
        for c in range(start[i], start[i + 1]):
            gap = normal_and_gap(i, other[c], position, radius, plane_point, plane_normal)[3]
            if gap < below:
                first[count], second[count], gaps[count] = i, other[c], gap
                count += 1
    return first[:count], second[:count], gaps[:count]


@compiled_for_teams
def pack_motion(velocity, inverse_mass, begin, end, motion):
    """Write bodies begin:end of workspace.motion (r, 8).

    `velocity` (n + p, 6) in m/s is linear and spin as surface velocity; `inverse_mass` [1/kg] is zero for planes.
    """
    for i in range(begin, end):
        for k in range(3):
            motion[i, k] = velocity[i, k]
            motion[i, 4 + k] = velocity[i, 3 + k]
        motion[i, 3] = inverse_mass[i]
        motion[i, 7] = 2.5 * inverse_mass[i]


@compiled_for_teams
def pack_place(position, radius, begin, end, place):
    """Write spheres begin:end of workspace.place (r, 8), from `position` (n, 3) and `radius` (n,) in m."""
    for i in range(begin, end):
        for k in range(3):
            place[i, k] = position[i, k]
        place[i, 3] = radius[i]
        place[i, 4] = place[i, 5] = place[i, 6] = place[i, 7] = 0.0


@compiled_for_teams
def pack_planes(s, plane_point, plane_normal, workspace):
    """Write the rows of slab `s` alone (private_rows), and the places of the planes, in `workspace`."""
    spheres = workspace.wall + 1 - workspace.planes
    nobody, row = private_rows(s, workspace)
    workspace.motion[nobody] = workspace.place[nobody] = 0.0
    for p in range(workspace.planes):
        workspace.motion[row + p] = workspace.motion[spheres + p]
        for at in (row + p, spheres + p):
            for k in range(3):
                workspace.place[at, k], workspace.place[at, 4 + k] = plane_point[p, k], plane_normal[p, k]
            workspace.place[at, 3], workspace.place[at, 7] = 0.0, 1.0


@compiled_for_teams
def unpack_motion(motion, begin, end, velocity):
    """Write velocities of bodies begin:end from `motion`: the reverse of `pack_motion`, without masses."""
    for i in range(begin, end):
        for k in range(3):
            velocity[i, k] = motion[i, k]
            velocity[i, 3 + k] = motion[i, 4 + k]


@compiled_for_teams
def lay_in(rank, members, barrier, impulse, pair, contacts):
    """Put impulses (pairs, 3) [N s] from the list of pairs into blocks of contacts; run by all members.

    They stay there as long as the list does. `pair` (8 b,) is the place of each lane in the list; -1, left over: zeros.
    """
    mark_started(barrier)
    begin, end = partition(rank, members, pair.shape[0] // WIDTH)
    for block in range(begin, end):
        for lane in range(WIDTH):
            c = pair[WIDTH * block + lane]
            for k in range(3):
                contacts[block, 3 + k, lane] = impulse[c, k] if c >= 0 else 0.0


@compiled_for_teams
def take_out(rank, members, barrier, impulse, pair, contacts):
    """Write impulses [N s] of the blocks of contacts to `impulse` (pairs, 3), of the list: the reverse of `lay_in`."""
    mark_started(barrier)
    begin, end = partition(rank, members, pair.shape[0] // WIDTH)
    for block in range(begin, end):
        for lane in range(WIDTH):
            c = pair[WIDTH * block + lane]
            if c >= 0:
                for k in range(3):
                    impulse[c, k] = contacts[block, 3 + k, lane]


@compiled_for_teams
def pack_slab(s, slabs, workspace, dt, recovery_speed, allowed_overlap, margin):
    """Write the contacts of slab `s`, whose impulses stand in `workspace`: pairs that may touch in the step.

    A pair takes part when its gap, less the approach at the free velocity, is below `margin` [m]. Any other is given no
    impulse, no mass, and a target that it cannot miss. The account gets the number and the largest overlap [m].
    """
    zero, one, half = zeros(), broadcast(1.0), broadcast(0.5)
    contacts = workspace.contacts
    count, deepest = zero, zero
    for block in range(slabs.begin[s], slabs.begin[s + 1]):
        i, j = (
            gather(workspace.place, slabs.blocks, block, 1),
            gather(workspace.place, slabs.blocks, block, 2),
        )
        x, y, z = j[0] - i[0], j[1] - i[1], j[2] - i[2]
        square = x * x + y * y + z * z
        distance, to_plane = sqrt(square), zero - (x * j[4] + y * j[5] + z * j[6])
        length = select_greater(square, zero, distance, one)
        x = select_greater(j[7], half, zero - j[4], x / length)
        y = select_greater(j[7], half, zero - j[5], y / length)
        z = select_greater(square, zero, z / length, one)  # of two spheres in one place, see normal_and_gap
        z = select_greater(j[7], half, zero - j[6], z)
        gap = select_greater(j[7], half, to_plane, distance) - i[3] - j[3]
        gap = select_greater(i[3] + j[3], zero, gap, broadcast(OUT_OF_REACH))  # in lanes left over
        i, j = (
            gather(workspace.motion, slabs.blocks, block, 1),
            gather(workspace.motion, slabs.blocks, block, 2),
        )
        inverse = i[3] + j[3]
        gap = select_greater(
            inverse, zero, gap, broadcast(OUT_OF_REACH)
        )  # of two fixed bodies: never a contact
        opening = (j[0] - i[0]) * x + (j[1] - i[1]) * y + (j[2] - i[2]) * z
        # a pair that moves apart counts by its gap: an impact may turn its grains within the step
        least = gap + broadcast(dt) * select_greater(opening, zero, zero, opening)
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        overlap = zero - gap - broadcast(allowed_overlap)
        recovery = select_greater(overlap, zero, overlap, zero) / broadcast(dt)
        recovery = select_greater(recovery, broadcast(recovery_speed), broadcast(recovery_speed), recovery)
        target = select_greater(gap, zero, (zero - gap) / broadcast(dt), recovery)
        near, mass = broadcast(margin), one / inverse
        store(contacts, block, 0, x)
        store(contacts, block, 1, y)
        store(contacts, block, 2, z)
        for k in range(3, 6):
            store(contacts, block, k, select_greater(near, least, load(contacts, block, k), zero))
        store(contacts, block, 6, select_greater(near, least, target, broadcast(-OUT_OF_REACH)))
        store(contacts, block, 7, select_greater(near, least, mass, zero))
        for k in range(FORCE, contacts.shape[1]):
            store(contacts, block, k, zero)
        count = count + select_greater(near, least, one, zero)
        deepest = select_greater(zero - gap, deepest, zero - gap, deepest)
    workspace.account[s, COUNT] = total(count)
    workspace.account[s, DEEPEST] = largest(deepest)


@compiled_for_teams
def rebound(s, slabs, workspace, velocity, restitution):
    """Set targets [m/s] of contacts of slab `s` that would close within the step at the `velocity` [m/s] of its start.

    `restitution` is the speed after an impact over that before it (Newton).
    """
    spheres, row = workspace.wall + 1 - workspace.planes, private_rows(s, workspace)[1]
    contacts = workspace.contacts
    for block in range(slabs.begin[s], slabs.begin[s + 1]):
        for lane in range(WIDTH):
            i, j = slabs.blocks[block, 1, lane], slabs.blocks[block, 2, lane]
            if contacts[block, 7, lane] == 0.0:  # without mass: no contact in this step
                continue
            j = j if j <= workspace.wall else j - row + spheres  # the plane whose copy the slab has
            opening = 0.0
            for k in range(3):
                opening += (velocity[j, k] - velocity[i, k]) * contacts[block, k, lane]
            if opening < 0.0 and opening <= contacts[block, 6, lane]:
                contacts[block, 6, lane] = -restitution * opening


@compiled_for_teams
def step(rank, members, barrier, bodies, planes, slabs, workspace, gravity, drive, law, restitution, how):
    """Advance spheres by `dt` [s] in place; gives sweeps, their last relative change, largest overlap [m].

    Run by all members of a team, each with its slabs and its share of the `bodies`: position, radius, velocity, inverse
    mass. `velocity` (n + p, 6) has planes last, of inverse mass zero unless `drive` moves the last (guide_wall).
    """
    mark_started(barrier)
    position, radius, velocity, inverse_mass = bodies
    plane_point, plane_normal = planes
    dt = how.dt
    n, count, last = position.shape[0], velocity.shape[0], slabs.begin.shape[0] - 2
    begin, end = partition(rank, members, n)
    pack_motion(velocity, inverse_mass, begin, end, workspace.motion)
    pack_place(position, radius, begin, end, workspace.place)
    if rank == 0:
        pack_motion(velocity, inverse_mass, n, count, workspace.motion)
    for i in range(begin, end):
        if inverse_mass[i] > 0.0:  # fixed spheres stay where they are
            for k in range(3):
                workspace.motion[i, k] += dt * gravity[k]
    # slabs read bodies that other members have packed
    barrier_wait(barrier, members)
    for kind in range(3):
        mine, others = first_and_end(rank, members, last, kind)
        for s in range(mine, others, 2):
            pack_planes(s, plane_point, plane_normal, workspace)
            pack_slab(s, slabs, workspace, dt, how.recovery_speed, how.allowed_overlap, how.margin)
            if restitution > 0.0:
                rebound(s, slabs, workspace, velocity, restitution)
    # the sweeps begin with the contacts counted in all slabs
    barrier_wait(barrier, members)
    calm, enough, most = how.penetration / dt, how.enough_sweeps, how.most_sweeps
    sweeps, change = sweep_until(
        rank, members, barrier, slabs, workspace, law, drive, how.tolerance, calm, enough, most
    )
    unpack_motion(workspace.motion, begin, end, velocity)
    if rank == 0:  # who guides the wall
        unpack_motion(workspace.motion, n, count, velocity)
    # by the velocity at the end of the step (theta = 1): the targets that just close a gap are set for it
    for i in range(begin, end):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]
    overlap = 0.0
    for s in range(last + 1):
        overlap = max(overlap, workspace.account[s, DEEPEST])
    return sweeps, change, overlap
