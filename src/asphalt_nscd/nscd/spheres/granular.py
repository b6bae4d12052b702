"""Rigid spheres and planes with Signorini-Coulomb contacts: one NSCD step.

Moreau-Jean time stepping with impulses (Eq. 14). The nonlinear Gauss-Seidel method visits the
contacts one by one; for spheres the local Delassus operator is diagonal in the contact frame, so
the local problem is solved exactly without ever building tangent vectors (gauss_seidel.py).

Spin is stored as surface velocity s = radius * angular velocity [m/s]: both bodies then enter the
contact in the same way, U = v_j - v_i - (s_i + s_j) x n, and m (2/5) s' = -n x r.
"""

from __future__ import annotations

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
from asphalt_nscd.nscd.spheres.slabs import first_and_end, private_rows
from asphalt_nscd.nscd.team import barrier_wait, mark_started, partition

OUT_OF_REACH = 1e30  # m or m/s


@compiled_for_teams
def normal_and_gap(i, j, position, radius, plane_point, plane_normal):
    """(x, y, z, gap): unit normal from body i to body j, and their gap [m].

    Parameters
    ----------
    i : int
        A sphere.
    j : int
        A sphere, or from n on plane j - n.
    position : ndarray (n, 3)
        Centres [m].
    radius : ndarray (n,)
        [m].
    plane_point, plane_normal : ndarray (p, 3)
        [m], and unit normals that point to the spheres.

    Returns
    -------
    tuple of float
        Normal x, y, z, and the gap [m], below zero where they overlap; spheres in one place part along z.
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
    """Pairs of a list that are near.

    Parameters
    ----------
    position : ndarray (n, 3)
        [m].
    radius : ndarray (n,)
        [m].
    plane_point, plane_normal : ndarray (p, 3)
        [m], and unit normals that point to the spheres.
    start, other : ndarray of int
        The list of pairs (neighbours.py).
    below : float
        Gap [m].

    Returns
    -------
    ndarray of int (c,)
        First body.
    ndarray of int (c,)
        Second body.
    ndarray (c,)
        Gap [m].
    """
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
    """Bodies begin:end of workspace.motion.

    Parameters
    ----------
    velocity : ndarray (n + p, 6)
        [m/s], linear and spin as surface velocity.
    inverse_mass : ndarray (n + p,)
        [1/kg], zero for planes.
    begin, end : int
        Bodies begin to end are written, and no others.
    motion : ndarray (r, 8)
        Of `Workspace`: a cache line for each body.
    """
    for i in range(begin, end):
        for k in range(3):
            motion[i, k] = velocity[i, k]
            motion[i, 4 + k] = velocity[i, 3 + k]
        motion[i, 3] = inverse_mass[i]
        motion[i, 7] = 2.5 * inverse_mass[i]


@compiled_for_teams
def pack_place(position, radius, begin, end, place):
    """Spheres begin:end of workspace.place.

    Parameters
    ----------
    position : ndarray (n, 3)
        Centres [m].
    radius : ndarray (n,)
        [m].
    begin, end : int
        Spheres begin to end are written, and no others.
    place : ndarray (r, 8)
        Of `Workspace`: a cache line for each body.
    """
    for i in range(begin, end):
        for k in range(3):
            place[i, k] = position[i, k]
        place[i, 3] = radius[i]
        place[i, 4] = place[i, 5] = place[i, 6] = place[i, 7] = 0.0


@compiled_for_teams
def pack_planes(s, plane_point, plane_normal, workspace):
    """The rows of slab s alone (private_rows), and the place of the wall.

    Parameters
    ----------
    s : int
        Slab.
    plane_point, plane_normal : ndarray (p, 3)
        [m], and unit normals that point to the spheres.
    workspace : Workspace
        Whose motion and place are written in the rows of the slab, and the places of the planes.
    """
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
    """The reverse of `pack_motion`, without the masses.

    Parameters
    ----------
    motion : ndarray (r, 8)
        Of `Workspace`.
    begin, end : int
        Bodies begin to end are written, and no others.
    velocity : ndarray (n + p, 6)
        [m/s], linear and spin as surface velocity.
    """
    for i in range(begin, end):
        for k in range(3):
            velocity[i, k] = motion[i, k]
            velocity[i, 3 + k] = motion[i, 4 + k]


@compiled_for_teams
def lay_in(rank, members, barrier, impulse, pair, contacts):
    """Impulses from the list of pairs to the blocks of contacts; run by all members of a team.

    They stay there from step to step, as long as the list does.

    Parameters
    ----------
    rank, members : int
        Which member of how many; each does a part of the blocks.
    barrier : ndarray
        Where they meet.
    impulse : ndarray (pairs, 3)
        On the second body of each pair [N s].
    pair : ndarray of int (8 b,)
        Place of each contact in the list; -1 where a lane is left over, which gets zeros.
    contacts : ndarray (b, 8, 8)
        Of `Workspace`.
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
    """Impulses from the blocks of contacts to the list of pairs: the reverse of `lay_in`.

    Parameters
    ----------
    rank, members : int
        Which member of how many; each does a part of the blocks.
    barrier : ndarray
        Where they meet.
    impulse : ndarray (pairs, 3)
        Written: on the second body of each pair [N s].
    pair : ndarray of int (8 b,)
        Place of each contact in the list; -1 where a lane is left over.
    contacts : ndarray (b, 8, 8)
        Of `Workspace`.
    """
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
    """The contacts of a slab, whose impulses stand in `workspace`: pairs that may touch within the step.

    A pair takes part when its gap, less the approach at the free velocity, is below `margin`. Any other is
    given no impulse, no mass, and a target that it cannot miss.

    Parameters
    ----------
    s : int
        Slab.
    slabs : Slabs
        Pairs in the order of slabs and blocks.
    workspace : Workspace
        Place and motion are read; contacts are written, and in its account their number and the largest
        overlap [m].
    dt : float
        Step [s].
    recovery_speed : float
        At most so fast is an overlap undone [m/s].
    allowed_overlap : float
        What stays of it [m].
    margin : float
        [m].
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
        opening = (j[0] - i[0]) * x + (j[1] - i[1]) * y + (j[2] - i[2]) * z
        # a pair that moves apart counts by its gap: an impact may turn its grains within the step
        least = gap + broadcast(dt) * select_greater(opening, zero, zero, opening)
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        overlap = zero - gap - broadcast(allowed_overlap)
        recovery = select_greater(overlap, zero, overlap, zero) / broadcast(dt)
        recovery = select_greater(recovery, broadcast(recovery_speed), broadcast(recovery_speed), recovery)
        target = select_greater(gap, zero, (zero - gap) / broadcast(dt), recovery)
        near, mass = broadcast(margin), one / (i[3] + j[3])
        store(contacts, block, 0, x)
        store(contacts, block, 1, y)
        store(contacts, block, 2, z)
        for k in range(3, 6):
            store(contacts, block, k, select_greater(near, least, load(contacts, block, k), zero))
        store(contacts, block, 6, select_greater(near, least, target, broadcast(-OUT_OF_REACH)))
        store(contacts, block, 7, select_greater(near, least, mass, zero))
        count = count + select_greater(near, least, one, zero)
        deepest = select_greater(zero - gap, deepest, zero - gap, deepest)
    workspace.account[s, COUNT] = total(count)
    workspace.account[s, DEEPEST] = largest(deepest)


@compiled_for_teams
def rebound(s, slabs, workspace, velocity, restitution):
    """Targets of those contacts of slab s that would close within the step at the velocities of its start.

    Parameters
    ----------
    s : int
        Slab.
    slabs : Slabs
        Pairs in the order of slabs and blocks.
    workspace : Workspace
        Of `pack_slab`; targets [m/s] of its contacts are written.
    velocity : ndarray (n + p, 6)
        At the start of the step [m/s].
    restitution : float
        Speed after an impact over that before it (Newton).
    """
    spheres, row = workspace.wall + 1 - workspace.planes, private_rows(s, workspace)[1]
    contacts = workspace.contacts
    for block in range(slabs.begin[s], slabs.begin[s + 1]):
        for lane in range(WIDTH):
            i, j = slabs.blocks[block, 1, lane], slabs.blocks[block, 2, lane]
            if contacts[block, 7, lane] == 0.0:
                continue
            j = j if j <= workspace.wall else j - row + spheres
            opening = 0.0
            for k in range(3):
                opening += (velocity[j, k] - velocity[i, k]) * contacts[block, k, lane]
            if opening < 0.0 and opening <= contacts[block, 6, lane]:
                contacts[block, 6, lane] = -restitution * opening


@compiled_for_teams
def step(
    rank,
    members,
    barrier,
    position,
    radius,
    velocity,
    inverse_mass,
    plane_point,
    plane_normal,
    gravity,
    slabs,
    workspace,
    drive,
    dt,
    friction,
    restitution,
    recovery_speed,
    allowed_overlap,
    margin,
    tolerance,
    penetration,
    enough_sweeps,
    most_sweeps,
):
    """Advance spheres by one step; position, velocity and impulses change in place. Run by all members of a team.

    Each member does its slabs and its share of the bodies. Overlaps beyond allowed_overlap are undone, no
    faster than by recovery_speed.

    Parameters
    ----------
    rank, members : int
        Which member of how many.
    barrier : ndarray
        Where they meet.
    position : ndarray (n, 3)
        [m].
    radius : ndarray (n,)
        [m].
    velocity : ndarray (n + p, 6)
        [m/s], linear and spin; planes last, prescribed.
    inverse_mass : ndarray (n + p,)
        [1/kg], zero for planes.
    plane_point, plane_normal : ndarray (p, 3)
        [m], and unit normals that point to the spheres.
    gravity : ndarray (3,)
        [m/s2].
    slabs : Slabs
        The pairs.
    workspace : Workspace
        For at least as many; `contacts` has the impulses of the last step.
    drive : ndarray (2,)
        Speed [m/s] and largest impulse [N s] of the last plane where its mass is finite (guide_wall).
    dt : float
        [s].
    friction : tuple of float
        Between spheres, and with planes.
    restitution : float
        Of impacts.
    recovery_speed : float
        [m/s]; zero: overlaps are never undone.
    allowed_overlap : float
        [m].
    margin : float
        Gap below which a pair is a contact [m].
    tolerance : float
        Of sweep_until.
    penetration : float
        What a step may add to an overlap [m].
    enough_sweeps, most_sweeps : int
        Of sweep_until.

    Returns
    -------
    int
        Sweeps.
    float
        Relative change of the last sweep.
    float
        Largest overlap at the start [m].
    """
    mark_started(barrier)
    n, bodies, last = position.shape[0], velocity.shape[0], slabs.begin.shape[0] - 2
    begin, end = partition(rank, members, n)
    pack_motion(velocity, inverse_mass, begin, end, workspace.motion)
    pack_place(position, radius, begin, end, workspace.place)
    if rank == 0:
        pack_motion(velocity, inverse_mass, n, bodies, workspace.motion)
    for i in range(begin, end):
        for k in range(3):
            workspace.motion[i, k] += dt * gravity[k]
    # slabs read bodies that other members have packed
    barrier_wait(barrier, members)
    for kind in range(3):
        mine, others = first_and_end(rank, members, last, kind)
        for s in range(mine, others, 2):
            pack_planes(s, plane_point, plane_normal, workspace)
            pack_slab(s, slabs, workspace, dt, recovery_speed, allowed_overlap, margin)
            if restitution > 0.0:
                rebound(s, slabs, workspace, velocity, restitution)
    # the sweeps begin with the contacts counted in all slabs
    barrier_wait(barrier, members)
    sweeps, change = sweep_until(
        rank,
        members,
        barrier,
        slabs,
        workspace,
        friction,
        drive,
        tolerance,
        penetration / dt,
        enough_sweeps,
        most_sweeps,
    )
    unpack_motion(workspace.motion, begin, end, velocity)
    if rank == 0:  # who guides the wall
        unpack_motion(workspace.motion, n, bodies, velocity)
    # by the velocity at the end of the step (theta = 1): the targets that just close a gap are set for it
    for i in range(begin, end):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]
    overlap = 0.0
    for s in range(last + 1):
        overlap = max(overlap, workspace.account[s, DEEPEST])
    return sweeps, change, overlap
