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
from asphalt_nscd.nscd.lanes import WIDTH, gather, largest, nothing, root, scatter, spread, total, where_above
from asphalt_nscd.nscd.spheres.gauss_seidel import COUNT, DEEPEST, sweep_until
from asphalt_nscd.nscd.spheres.slabs import first_and_end, own_rows
from asphalt_nscd.nscd.team import arrive, meet, share

OUT_OF_REACH = 1e30  # m or m/s


@compiled_for_teams
def normal_and_gap(i, j, position, radius, plane_point, plane_normal):
    """(x, y, z, gap): unit normal from body i to body j, and their gap [m]."""
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
    """Pairs of a list with a gap below `below` [m]: (first (c,), second (c,), gap (c,))."""
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
    """Bodies begin:end of room.motion."""
    for i in range(begin, end):
        for k in range(3):
            motion[i, k] = velocity[i, k]
            motion[i, 4 + k] = velocity[i, 3 + k]
        motion[i, 3] = inverse_mass[i]
        motion[i, 7] = 2.5 * inverse_mass[i]


@compiled_for_teams
def pack_place(position, radius, begin, end, place):
    """Spheres begin:end of room.place."""
    for i in range(begin, end):
        for k in range(3):
            place[i, k] = position[i, k]
        place[i, 3] = radius[i]
        place[i, 4] = place[i, 5] = place[i, 6] = place[i, 7] = 0.0


@compiled_for_teams
def pack_planes(s, plane_point, plane_normal, room):
    """The rows of slab s alone (own_rows), and the place of the wall."""
    spheres = room.wall + 1 - room.planes
    no_contact, nobody, row = own_rows(s, room)
    room.packed[no_contact] = room.motion[nobody] = room.place[nobody] = 0.0
    for p in range(room.planes):
        room.motion[row + p] = room.motion[spheres + p]
        for at in (row + p, spheres + p):
            for k in range(3):
                room.place[at, k], room.place[at, 4 + k] = plane_point[p, k], plane_normal[p, k]
            room.place[at, 3], room.place[at, 7] = 0.0, 1.0


@compiled_for_teams
def unpack_motion(motion, begin, end, velocity):
    """The other way round."""
    for i in range(begin, end):
        for k in range(3):
            velocity[i, k] = motion[i, k]
            velocity[i, 3 + k] = motion[i, 4 + k]


@compiled_for_teams
def lay_in(impulse, slabs, room, begin, end):
    """The impulses of the list of pairs (pairs, 3) into contacts begin:end."""
    for c in range(begin, end):
        pair = slabs.pair[c]
        for k in range(3):
            room.packed[c, 3 + k] = impulse[pair, k] if pair >= 0 else 0.0


@compiled_for_teams
def take_out(impulse, slabs, room, begin, end):
    """The other way round."""
    for c in range(begin, end):
        pair = slabs.pair[c]
        if pair >= 0:
            for k in range(3):
                impulse[pair, k] = room.packed[c, 3 + k]


@compiled_for_teams
def pack_slab(s, slabs, room, dt, recovery_speed, allowed_overlap, margin):
    """The contacts of slab s, whose impulses stand in `room`: pairs that may touch within the step.

    A pair takes part when its gap, less the approach at the free velocity, is below `margin` [m]. Any other is
    given no impulse, no mass, and a target that it cannot miss.
    """
    zero, one, half = nothing(), spread(1.0), spread(0.5)
    count, deepest = zero, zero
    for block in range(slabs.begin[s], slabs.begin[s + 1]):
        contact = gather(room.packed, slabs.blocks, block, 0)
        i, j = gather(room.place, slabs.blocks, block, 1), gather(room.place, slabs.blocks, block, 2)
        x, y, z = j[0] - i[0], j[1] - i[1], j[2] - i[2]
        square = x * x + y * y + z * z
        distance, to_plane = root(square), zero - (x * j[4] + y * j[5] + z * j[6])
        length = where_above(square, zero, distance, one)
        x = where_above(j[7], half, zero - j[4], x / length)
        y = where_above(j[7], half, zero - j[5], y / length)
        z = where_above(square, zero, z / length, one)  # of two spheres in one place, see normal_and_gap
        z = where_above(j[7], half, zero - j[6], z)
        gap = where_above(j[7], half, to_plane, distance) - i[3] - j[3]
        gap = where_above(i[3] + j[3], zero, gap, spread(OUT_OF_REACH))  # in lanes left over
        i, j = gather(room.motion, slabs.blocks, block, 1), gather(room.motion, slabs.blocks, block, 2)
        opening = (j[0] - i[0]) * x + (j[1] - i[1]) * y + (j[2] - i[2]) * z
        least = gap + spread(dt) * where_above(opening, zero, zero, opening)
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        overlap = zero - gap - spread(allowed_overlap)
        recovery = where_above(overlap, zero, overlap, zero) / spread(dt)
        recovery = where_above(recovery, spread(recovery_speed), spread(recovery_speed), recovery)
        target = where_above(gap, zero, (zero - gap) / spread(dt), recovery)
        near, mass = spread(margin), one / (i[3] + j[3])
        packed = (
            x, y, z,
            where_above(near, least, contact[3], zero),
            where_above(near, least, contact[4], zero),
            where_above(near, least, contact[5], zero),
            where_above(near, least, target, spread(-OUT_OF_REACH)),
            where_above(near, least, mass, zero),
        )  # fmt: skip
        scatter(room.packed, slabs.blocks, block, 0, packed)
        count = count + where_above(near, least, one, zero)
        deepest = where_above(zero - gap, deepest, zero - gap, deepest)
    room.account[s, COUNT] = total(count)
    room.account[s, DEEPEST] = largest(deepest)


@compiled_for_teams
def rebound(s, slabs, room, velocity, restitution):
    """Targets of those contacts of slab s that would close within the step at the velocities of its start."""
    spheres, row = room.wall + 1 - room.planes, own_rows(s, room)[2]
    for block in range(slabs.begin[s], slabs.begin[s + 1]):
        for lane in range(WIDTH):
            c, i, j = slabs.blocks[block, 0, lane], slabs.blocks[block, 1, lane], slabs.blocks[block, 2, lane]
            if room.packed[c, 7] == 0.0:
                continue
            j = j if j <= room.wall else j - row + spheres
            opening = 0.0
            for k in range(3):
                opening += (velocity[j, k] - velocity[i, k]) * room.packed[c, k]
            if opening < 0.0 and opening <= room.packed[c, 6]:
                room.packed[c, 6] = -restitution * opening


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
    impulse,
    slabs,
    room,
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
    """Advance spheres by dt [s]; position, velocity and impulse (per pair) change in place.

    Run by all members of a team (rank, members, barrier); each does its slabs and its share of the bodies.
    position (n, 3) [m]; velocity (n + p, 6) [m/s] (linear, spin; planes last, prescribed);
    inverse_mass (n + p,) [1/kg], zero for planes; gravity (3,) [m/s2]; impulse (pairs, 3) [N s];
    slabs: the pairs (Slabs); room: for at least as many (Room).
    Overlaps beyond allowed_overlap [m] are undone, no faster than by recovery_speed [m/s] (zero: never).
    Sweeps end as in sweep_until; penetration [m] is what a step may add to an overlap.
    drive (2,): speed [m/s] and largest impulse [N s] of the last plane where its mass is finite (guide_wall).
    Returns (sweeps, relative change of the last sweep, largest overlap at the start [m]).
    """
    arrive(barrier)
    n, bodies, last = position.shape[0], velocity.shape[0], slabs.begin.shape[0] - 2
    begin, end = share(rank, members, n)
    pack_motion(velocity, inverse_mass, begin, end, room.motion)
    pack_place(position, radius, begin, end, room.place)
    if rank == 0:
        pack_motion(velocity, inverse_mass, n, bodies, room.motion)
    for i in range(begin, end):
        for k in range(3):
            room.motion[i, k] += dt * gravity[k]
    meet(barrier, members)
    for kind in range(3):
        mine, others = first_and_end(rank, members, last, kind)
        for s in range(mine, others, 2):
            pack_planes(s, plane_point, plane_normal, room)
            lay_in(impulse, slabs, room, WIDTH * slabs.begin[s], WIDTH * slabs.begin[s + 1])
            pack_slab(s, slabs, room, dt, recovery_speed, allowed_overlap, margin)
            if restitution > 0.0:
                rebound(s, slabs, room, velocity, restitution)
    meet(barrier, members)
    sweeps, change = sweep_until(
        rank,
        members,
        barrier,
        slabs,
        room,
        friction,
        drive,
        tolerance,
        penetration / dt,
        enough_sweeps,
        most_sweeps,
    )
    for kind in range(3):
        mine, others = first_and_end(rank, members, last, kind)
        for s in range(mine, others, 2):
            take_out(impulse, slabs, room, WIDTH * slabs.begin[s], WIDTH * slabs.begin[s + 1])
    unpack_motion(room.motion, begin, end, velocity)
    if rank == 0:  # who guides the wall
        unpack_motion(room.motion, n, bodies, velocity)
    for i in range(begin, end):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]
    overlap = 0.0
    for s in range(last + 1):
        overlap = max(overlap, room.account[s, DEEPEST])
    return sweeps, change, overlap
