"""Gauss-Seidel sweeps over the contacts of rigid spheres, laid out for the speed of the processor.

What a contact needs fills one cache line, and so does what a body needs. Contacts stand slab by slab (slabs.py).
A sweep visits the last body, which all may touch, then the slabs of even number, then those of odd number. Slabs of
one kind share no body, so that members of a team can sweep them side by side: numbers are the same for any number
of threads.

Most contacts are quiet, so that only one sweep in a round visits all. A few converge slowly: those of light grains
that heavier ones squeeze. Over-relaxation helps them if all sweeps run the same way (up and down by turns it does
not), so every sweep is from the top, where impacts come from, down. Sweeps that decide whether to end are not
over-relaxed, nor are those before them.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled_for_teams
from asphalt_nscd.nscd.contacts.coulomb import cut
from asphalt_nscd.nscd.spheres.slabs import first_and_end
from asphalt_nscd.nscd.team import meet

ROUND = 9  # sweeps, the first of which visits all contacts and the others those that were not quiet
RELAXATION = 1.5  # of all sweeps of a round but the first and the last; below 2
ORDER = (2, 0, 1)  # in which the kinds of slabs are swept, see sweep_slabs

CHANGED, SIZE, FASTEST, NOTED, COUNT, DEEPEST, PUSHED = range(7)  # columns of the account of a slab


@compiled_for_teams
def apply_impulse(i, j, nx, ny, nz, px, py, pz, motion):
    """Give impulse p [N s] to body j and its opposite to body i at their point of contact."""
    wi, wj = motion[i, 3], motion[j, 3]
    ui, uj = motion[i, 7], motion[j, 7]
    tx = ny * pz - nz * py
    ty = nz * px - nx * pz
    tz = nx * py - ny * px
    motion[i, 0] -= wi * px
    motion[i, 1] -= wi * py
    motion[i, 2] -= wi * pz
    motion[i, 4] -= ui * tx
    motion[i, 5] -= ui * ty
    motion[i, 6] -= ui * tz
    if wj == 0.0:
        return  # a plane, which many threads read
    motion[j, 0] += wj * px
    motion[j, 1] += wj * py
    motion[j, 2] += wj * pz
    motion[j, 4] -= uj * tx
    motion[j, 5] -= uj * ty
    motion[j, 6] -= uj * tz


@compiled_for_teams
def sweep_contacts(bodies, packed, motion, friction, visits, begin, end, relaxation, quiet, calm, lively):
    """One Gauss-Seidel sweep over contacts visits[begin:end]; updates impulses and motion.

    Signorini on velocities: opening >= target, impulse >= 0, complementary; Coulomb with `friction`.
    The local Delassus operator is diagonal: normal 1/m_i + 1/m_j, tangential 7/2 of it. The change of an impulse is
    multiplied by `relaxation` before the laws cut it.
    Contacts whose impulse changes by more than the root of `quiet` [N2 s2], and those that close faster than
    they may by more than `calm` [m/s], are noted in `lively` from `begin` on. Returns the sums of
    squares of the change of impulse and of the impulse, the largest excess of speed [m/s], how many were noted.
    """
    changed = 0.0
    size = 0.0
    noted = 0
    fastest = 0.0
    for k in range(begin, end):
        c = visits[k]
        i, j = bodies[c, 0], bodies[c, 1]
        nx, ny, nz = packed[c, 0], packed[c, 1], packed[c, 2]
        px, py, pz = packed[c, 3], packed[c, 4], packed[c, 5]
        mass = relaxation * packed[c, 7]
        vx = motion[j, 0] - motion[i, 0]
        vy = motion[j, 1] - motion[i, 1]
        vz = motion[j, 2] - motion[i, 2]
        opening = vx * nx + vy * ny + vz * nz
        excess = packed[c, 6] - opening
        old_normal = px * nx + py * ny + pz * nz
        new_normal = old_normal + excess * mass
        if new_normal <= 0.0:
            if px == 0.0 and py == 0.0 and pz == 0.0:
                continue  # open and stays open
            qx = qy = qz = 0.0
        else:
            sx = motion[j, 4] + motion[i, 4]
            sy = motion[j, 5] + motion[i, 5]
            sz = motion[j, 6] + motion[i, 6]
            softness = mass / 3.5
            along = old_normal - softness * opening
            qx = px - softness * (vx - (sy * nz - sz * ny)) - along * nx
            qy = py - softness * (vy - (sz * nx - sx * nz)) - along * ny
            qz = pz - softness * (vz - (sx * ny - sy * nx)) - along * nz
            qx, qy, qz = cut(qx, qy, qz, friction * new_normal)
            qx += new_normal * nx
            qy += new_normal * ny
            qz += new_normal * nz
        dx, dy, dz = qx - px, qy - py, qz - pz
        apply_impulse(i, j, nx, ny, nz, dx, dy, dz, motion)
        packed[c, 3], packed[c, 4], packed[c, 5] = qx, qy, qz
        moved = dx * dx + dy * dy + dz * dz
        if moved > quiet or excess > calm:
            lively[begin + noted] = c
            noted += 1
        fastest = max(fastest, excess)
        changed += moved
        size += qx * qx + qy * qy + qz * qz
    return changed, size, fastest, noted


@compiled_for_teams
def guide_wall(motion, drive, push):
    """The last body, a wall between rails: it moves along z, no faster down than drive[0] [m/s].

    Its drive pushes it down with the impulse that this takes, but at most with drive[1] [N s], and pulls
    without limit. push [N s] is the impulse so far. Returns the new one. A wall of infinite mass needs none.
    """
    inverse_mass = motion[-1, 3]
    if inverse_mass == 0.0:
        return push
    motion[-1, :2] = 0.0
    motion[-1, 4:7] = 0.0
    new = min(push + (motion[-1, 2] - drive[0]) / inverse_mass, drive[1])
    motion[-1, 2] -= inverse_mass * (new - push)
    return new


@compiled_for_teams
def push_slab(bodies, packed, motion, begin, end):
    """Give the impulses that contacts begin:end start with to their bodies. Returns the sum of their squares."""
    size = 0.0
    for c in range(begin, end):
        size += packed[c, 3] ** 2 + packed[c, 4] ** 2 + packed[c, 5] ** 2
        apply_impulse(
            bodies[c, 0],
            bodies[c, 1],
            packed[c, 0],
            packed[c, 1],
            packed[c, 2],
            packed[c, 3],
            packed[c, 4],
            packed[c, 5],
            motion,
        )
    return size


@compiled_for_teams
def sweep_slabs(rank, members, barrier, begin, room, friction, kind, relaxation, everyone, quiet, calm):
    """A member's part of a sweep over the slabs of one kind (0 even, 1 odd, 2 the last body), then a meeting.

    Over all contacts, or over those that were noted.
    """
    slabs = begin.shape[0] - 2
    first, end = first_and_end(rank, members, slabs, kind)
    column = COUNT if everyone else NOTED
    visits = room.everyone if everyone else room.lively
    for s in range(first, end, 2):
        changed, size, fastest, noted = sweep_contacts(
            room.bodies,
            room.packed,
            room.motion,
            friction,
            visits,
            begin[s],
            begin[s] + int(room.account[s, column]),
            relaxation,
            quiet,
            calm,
            room.lively,
        )
        if everyone:
            room.account[s, CHANGED], room.account[s, SIZE] = changed, size
            room.account[s, FASTEST], room.account[s, NOTED] = fastest, noted
    meet(barrier, members)


@compiled_for_teams
def sweep_until(
    rank, members, barrier, begin, room, friction, drive, tolerance, calm, enough_sweeps, most_sweeps
):
    """Gauss-Seidel from the given impulses until their relative change is below tolerance.

    Sweeps run in rounds. The first of each visits all contacts and decides whether to end; the others visit those
    whose impulse then changed by more than `tolerance` of the root mean square impulse, or that closed faster
    than they may by more than `calm` [m/s]. After enough_sweeps the tolerance is waived, `calm` never.
    Contacts begin[s]:begin[s] + account[s, COUNT] of `room` are those of slab s. Run by all members of a team.
    Returns (sweeps of either kind, relative change of the last sweep over all contacts).
    """
    slabs = begin.shape[0] - 2
    account, motion = room.account, room.motion
    contacts = 0
    for s in range(slabs + 1):
        contacts += int(account[s, COUNT])
    idle = 0 if account[slabs, COUNT] > 0.0 else 1  # the last body touches nothing
    for k in range(idle, 3):
        first, end = first_and_end(rank, members, slabs, ORDER[k])
        for s in range(first, end, 2):
            stop = begin[s] + int(account[s, COUNT])
            account[s, PUSHED] = push_slab(room.bodies, room.packed, motion, begin[s], stop)
        meet(barrier, members)
    size = 0.0
    for s in range(slabs + 1 - idle):  # in one order, whoever pushed or swept them
        size += account[s, PUSHED]
    push = guide_wall(motion, drive, 0.0) if rank == 0 else 0.0
    change = 0.0
    for sweep in range(most_sweeps):
        turn = sweep % ROUND
        everyone = turn == 0
        relaxation = 1.0 if everyone or turn == ROUND - 1 else RELAXATION
        quiet, limit = np.inf, np.inf
        if everyone:
            quiet, limit = tolerance * tolerance * size / max(contacts, 1), calm
        for k in range(idle, 3):
            sweep_slabs(
                rank, members, barrier, begin, room, friction, ORDER[k], relaxation, everyone, quiet, limit
            )
        if rank == 0:
            push = guide_wall(motion, drive, push)
        if everyone:
            changed, size, fastest = 0.0, 0.0, 0.0
            for s in range(slabs + 1 - idle):
                changed += account[s, CHANGED]
                size += account[s, SIZE]
                fastest = max(fastest, account[s, FASTEST])
            change = np.sqrt(changed / size) if size > 0.0 else 0.0
            if fastest < calm and (change < tolerance or sweep >= enough_sweeps):
                return sweep + 1, change
    return most_sweeps, change
