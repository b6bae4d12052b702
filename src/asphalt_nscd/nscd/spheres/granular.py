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
from asphalt_nscd.nscd.spheres.gauss_seidel import COUNT, DEEPEST, sweep_until
from asphalt_nscd.nscd.spheres.slabs import first_and_end
from asphalt_nscd.nscd.team import meet, share


@compiled_for_teams
def normal_and_gap(i, j, position, radius, plane_point, plane_normal):
    """(x, y, z, gap): unit normal from body i to body j, and their gap [m]."""
    n = position.shape[0]
    if j < n:
        x = position[j, 0] - position[i, 0]
        y = position[j, 1] - position[i, 1]
        z = position[j, 2] - position[i, 2]
        distance = np.sqrt(x * x + y * y + z * z)
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
    """Bodies begin:end of motion (bodies, 8); see Room."""
    for i in range(begin, end):
        for k in range(3):
            motion[i, k] = velocity[i, k]
            motion[i, 4 + k] = velocity[i, 3 + k]
        motion[i, 3] = inverse_mass[i]
        motion[i, 7] = 2.5 * inverse_mass[i]


@compiled_for_teams
def unpack_motion(motion, begin, end, velocity):
    """The other way round."""
    for i in range(begin, end):
        for k in range(3):
            velocity[i, k] = motion[i, k]
            velocity[i, 3 + k] = motion[i, 4 + k]


@compiled_for_teams
def pack_slab(
    s,
    position,
    radius,
    velocity,
    plane_point,
    plane_normal,
    impulse,
    slabs,
    room,
    dt,
    restitution,
    recovery_speed,
    allowed_overlap,
    margin,
):
    """The contacts of slab s, written into `room`: pairs that may touch within the step.

    A pair takes part when its gap, less the approach at the free velocity, is below `margin` [m]. The impulse of
    any other is set to zero.
    """
    start = slabs.begin[s]
    motion, packed = room.motion, room.packed
    at = start
    deepest = 0.0
    for p in range(start, slabs.begin[s + 1]):
        i, j, pair = slabs.first[p], slabs.second[p], slabs.pair[p]
        x, y, z, gap = normal_and_gap(i, j, position, radius, plane_point, plane_normal)
        vx, vy, vz = motion[j, 0] - motion[i, 0], motion[j, 1] - motion[i, 1], motion[j, 2] - motion[i, 2]
        if gap + dt * min(vx * x + vy * y + vz * z, 0.0) >= margin:
            impulse[pair, 0] = impulse[pair, 1] = impulse[pair, 2] = 0.0
            continue
        deepest = max(deepest, -gap)
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        overlap = max(-gap - allowed_overlap, 0.0)
        target = -gap / dt if gap > 0.0 else min(overlap / dt, recovery_speed)
        if restitution > 0.0:
            opening = (velocity[j, 0] - velocity[i, 0]) * x
            opening += (velocity[j, 1] - velocity[i, 1]) * y
            opening += (velocity[j, 2] - velocity[i, 2]) * z
            if opening < 0.0 and gap + dt * opening <= 0.0:
                target = -restitution * opening
        room.active[at] = p
        room.bodies[at, 0], room.bodies[at, 1] = i, j
        packed[at, 0], packed[at, 1], packed[at, 2] = x, y, z
        packed[at, 3], packed[at, 4], packed[at, 5] = impulse[pair, 0], impulse[pair, 1], impulse[pair, 2]
        packed[at, 6] = target
        packed[at, 7] = 1.0 / (motion[i, 3] + motion[j, 3])
        at += 1
    room.account[s, COUNT] = at - start
    room.account[s, DEEPEST] = deepest


@compiled_for_teams
def unpack_slab(s, impulse, slabs, room):
    """The impulses of the contacts of slab s back to the list of pairs."""
    start = slabs.begin[s]
    for at in range(start, start + int(room.account[s, COUNT])):
        pair = slabs.pair[room.active[at]]
        for k in range(3):
            impulse[pair, k] = room.packed[at, 3 + k]


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
    n, bodies, last = position.shape[0], velocity.shape[0], slabs.begin.shape[0] - 2
    begin, end = share(rank, members, n)
    pack_motion(velocity, inverse_mass, begin, end, room.motion)
    if rank == 0:
        pack_motion(velocity, inverse_mass, n, bodies, room.motion)
    for i in range(begin, end):
        for k in range(3):
            room.motion[i, k] += dt * gravity[k]
    meet(barrier, members)
    for kind in range(3):
        mine, others = first_and_end(rank, members, last, kind)
        for s in range(mine, others, 2):
            pack_slab(
                s,
                position,
                radius,
                velocity,
                plane_point,
                plane_normal,
                impulse,
                slabs,
                room,
                dt,
                restitution,
                recovery_speed,
                allowed_overlap,
                margin,
            )
    meet(barrier, members)
    sweeps, change = sweep_until(
        rank,
        members,
        barrier,
        slabs.begin,
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
            unpack_slab(s, impulse, slabs, room)
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
