"""Gauss-Seidel sweeps over the contacts of rigid spheres, laid out for the speed of the processor.

What a contact needs fills one cache line, and so does what a body needs. Contacts that follow one
another in the list share spheres, so each would wait for the result of the one before; they are
dealt out so that neighbours in the list are visited far apart. Most contacts of a shaken pile are quiet,
so that only one sweep in a round visits all.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled

BLOCK = 1024  # contacts dealt out among themselves
HANDS = 8
ROUND = 6  # sweeps, the first of which visits all contacts and the others those that were not quiet


@compiled
def place(c, contacts):
    """Where in the order of visits contact c of so many stands."""
    start = c // BLOCK * BLOCK
    if start + BLOCK > contacts:
        return c
    hand, card = (c - start) // (BLOCK // HANDS), (c - start) % (BLOCK // HANDS)
    return start + card * HANDS + hand


@compiled
def pack_motion(velocity, inverse_mass):
    """(bodies, 8): velocity [m/s], 1/mass [1/kg], spin as surface velocity [m/s], 5/2 of 1/mass."""
    motion = np.empty((velocity.shape[0], 8))
    motion[:, :3] = velocity[:, :3]
    motion[:, 3] = inverse_mass
    motion[:, 4:7] = velocity[:, 3:]
    motion[:, 7] = 2.5 * inverse_mass
    return motion


@compiled
def pack_contacts(pair, first, second, normal, target, impulse, inverse_mass):
    """In the order of visits: bodies (c, 2), and (c, 8) normal, impulse [N s], target [m/s], mass [kg].

    The mass is what an impulse along the normal has to move, 1 / (1/m_i + 1/m_j).
    """
    contacts = pair.shape[0]
    bodies = np.empty((contacts, 2), np.int32)
    packed = np.empty((contacts, 8))
    for c in range(contacts):
        i, j = first[c], second[c]
        at = place(c, contacts)
        bodies[at, 0], bodies[at, 1] = i, j
        packed[at, :3] = normal[c]
        packed[at, 3:6] = impulse[pair[c]]
        packed[at, 6] = target[c]
        packed[at, 7] = 1.0 / (inverse_mass[i] + inverse_mass[j])
    return bodies, packed


@compiled
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
    motion[j, 0] += wj * px
    motion[j, 1] += wj * py
    motion[j, 2] += wj * pz
    motion[j, 4] -= uj * tx
    motion[j, 5] -= uj * ty
    motion[j, 6] -= uj * tz


@compiled
def sweep_contacts(bodies, packed, motion, friction, visits, backward, quiet, calm, lively):
    """One Gauss-Seidel sweep over contacts visits (v,), or back; updates impulses and motion.

    Signorini on velocities: opening >= target, impulse >= 0, complementary; Coulomb with `friction`.
    The local Delassus operator is diagonal: normal 1/m_i + 1/m_j, tangential 7/2 of it.
    Contacts whose impulse changes by more than the root of `quiet` [N2 s2], and those that close faster than
    they may by more than `calm` [m/s], are noted in `lively`. Returns the sums of squares of the change of
    impulse and of the impulse, how many were noted, and the largest excess of speed [m/s].
    """
    changed = 0.0
    size = 0.0
    noted = 0
    fastest = 0.0
    for k in range(visits.shape[0]):
        c = visits[visits.shape[0] - 1 - k] if backward else visits[k]
        i, j = bodies[c, 0], bodies[c, 1]
        nx, ny, nz = packed[c, 0], packed[c, 1], packed[c, 2]
        px, py, pz = packed[c, 3], packed[c, 4], packed[c, 5]
        mass = packed[c, 7]
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
            square = qx * qx + qy * qy + qz * qz
            limit = friction * new_normal
            if square > limit * limit:
                share = limit / np.sqrt(square)
                qx *= share
                qy *= share
                qz *= share
            qx += new_normal * nx
            qy += new_normal * ny
            qz += new_normal * nz
        dx, dy, dz = qx - px, qy - py, qz - pz
        apply_impulse(i, j, nx, ny, nz, dx, dy, dz, motion)
        packed[c, 3], packed[c, 4], packed[c, 5] = qx, qy, qz
        moved = dx * dx + dy * dy + dz * dz
        if moved > quiet or excess > calm:
            lively[noted] = c
            noted += 1
        fastest = max(fastest, excess)
        changed += moved
        size += qx * qx + qy * qy + qz * qz
    return changed, size, noted, fastest


@compiled
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


@compiled
def sweep_until(bodies, packed, motion, friction, drive, tolerance, calm, enough_sweeps, most_sweeps):
    """Gauss-Seidel from the given impulses until their relative change is below tolerance.

    Sweeps run alternately up and down the list, which carries weight through a pile in one pass. The
    first of each round visits all contacts and decides whether to end; the others visit those whose
    impulse then changed by more than `tolerance` of the root mean square impulse, or that closed faster
    than they may by more than `calm` [m/s]. After enough_sweeps the tolerance is waived, `calm` never.
    Returns (sweeps of either kind, relative change of the last sweep over all contacts).
    """
    contacts = packed.shape[0]
    change = 0.0
    for c in range(contacts):
        apply_impulse(
            bodies[c, 0], bodies[c, 1], packed[c, 0], packed[c, 1], packed[c, 2],
            packed[c, 3], packed[c, 4], packed[c, 5], motion,
        )  # fmt: skip
    push = guide_wall(motion, drive, 0.0)
    everyone = np.arange(contacts)
    lively = np.empty(contacts, np.int64)
    noted, size = 0, 0.0
    for sweep in range(most_sweeps):
        turn = sweep % ROUND
        if turn == 0:
            quiet = tolerance * tolerance * size / max(contacts, 1)
            backward = sweep // ROUND % 2 == 1
            changed, size, noted, fastest = sweep_contacts(
                bodies, packed, motion, friction, everyone, backward, quiet, calm, lively
            )
            push = guide_wall(motion, drive, push)
            change = np.sqrt(changed / size) if size > 0.0 else 0.0
            if fastest < calm and (change < tolerance or sweep >= enough_sweeps):
                return sweep + 1, change
        else:
            backward = turn % 2 == 1
            sweep_contacts(bodies, packed, motion, friction, lively[:noted], backward, np.inf, np.inf, lively)
            push = guide_wall(motion, drive, push)
    return most_sweeps, change
