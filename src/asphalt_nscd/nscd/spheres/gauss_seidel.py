"""Gauss-Seidel sweeps over the contacts of rigid spheres, laid out for the speed of the processor.

What a body needs fills one cache line. Contacts stand slab by slab (slabs.py), in blocks of eight that share no body
(blocks.py), which are computed at once; each quantity of a block fills one line.
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
from asphalt_nscd.nscd.lanes import (
    WIDTH,
    broadcast,
    gather,
    greater_bits,
    largest,
    load,
    scatter,
    select_greater,
    store,
    total,
    zeros,
)
from asphalt_nscd.nscd.spheres.blocks import deal_lively, first_lively, give_back
from asphalt_nscd.nscd.spheres.laws import ContactLaw, new_couple, new_impulse
from asphalt_nscd.nscd.spheres.slabs import part_of
from asphalt_nscd.nscd.team import barrier_wait

ROUND = 9  # sweeps, the first of which visits all contacts and the others those that were not quiet
AGAIN = 4  # the sweep of a round that leaves out contacts which have become quiet, counted from 0
RELAXATION = 1.5  # of all sweeps of a round but the first and the last; below 2
ORDER = (2, 0, 1)  # in which the kinds of slabs are swept, see sweep_slabs

# columns of the account of a slab
CHANGED, SIZE, FASTEST, NOTED, COUNT, DEEPEST, PUSHED, LIVELY_BLOCKS = range(8)


@compiled_for_teams
def contacts_of(contacts, block):
    """Normal (3), impulse (3) [N s], target [m/s] and mass [kg] of the eight contacts of a block."""
    return (
        load(contacts, block, 0), load(contacts, block, 1), load(contacts, block, 2),
        load(contacts, block, 3), load(contacts, block, 4), load(contacts, block, 5),
        load(contacts, block, 6), load(contacts, block, 7),
    )  # fmt: skip


@compiled_for_teams
def push(motion, blocks, block, contact, i, j, x, y, z):
    """Give impulses [N s] at its contacts to the second bodies of a block, their opposites to the first."""
    nx, ny, nz = contact[:3]
    tx, ty, tz = ny * z - nz * y, nz * x - nx * z, nx * y - ny * x
    w, u = i[3], i[7]
    i = i[0] - w * x, i[1] - w * y, i[2] - w * z, w, i[4] - u * tx, i[5] - u * ty, i[6] - u * tz, u
    w, u = j[3], j[7]
    j = j[0] + w * x, j[1] + w * y, j[2] + w * z, w, j[4] - u * tx, j[5] - u * ty, j[6] - u * tz, u
    scatter(motion, blocks, block, 1, i)
    scatter(motion, blocks, block, 2, j)


@compiled_for_teams
def turn(motion, blocks, block, radii, i, j, x, y, z):
    """Give couples [N m s] to the second bodies of a block, their opposites to the first."""
    u = i[7] / radii[0]
    i = i[0], i[1], i[2], i[3], i[4] - u * x, i[5] - u * y, i[6] - u * z, i[7]
    u = select_greater(radii[1], zeros(), j[7] / radii[1], zeros())
    j = j[0], j[1], j[2], j[3], j[4] + u * x, j[5] + u * y, j[6] + u * z, j[7]
    scatter(motion, blocks, block, 1, i)
    scatter(motion, blocks, block, 2, j)


@compiled_for_teams
def sweep_couples(blocks, contacts, block, law, relaxation, workspace):
    """Let the contacts of a block, whose impulses are new, resist that their bodies turn against each other."""
    i, j = gather(workspace.motion, blocks, block, 1), gather(workspace.motion, blocks, block, 2)
    radii = gather(workspace.place, blocks, block, 1)[3], gather(workspace.place, blocks, block, 2)[3]
    # lanes left over have no size
    radii = select_greater(radii[0], zeros(), radii[0], broadcast(1.0)), radii[1]
    couple = load(contacts, block, 8), load(contacts, block, 9), load(contacts, block, 10)
    x, y, z = new_couple(law, contacts_of(contacts, block), couple, radii, i, j, relaxation)
    turn(workspace.motion, blocks, block, radii, i, j, x - couple[0], y - couple[1], z - couple[2])
    store(contacts, block, 8, x)
    store(contacts, block, 9, y)
    store(contacts, block, 10, z)


@compiled_for_teams
def sweep_blocks(
    blocks, contacts, begin, count, noted_from, law, relaxation, quiet, calm, workspace, rows, spare
):
    """One Gauss-Seidel sweep over blocks begin to begin + count; updates impulses and motion in place.

    Contacts whose impulse changes by more than the root of `quiet` [N2 s2], and those that close faster than they may
    by more than `calm` [m/s], go into workspace.lively from `noted_from` on; the others into row `spare`. Returns sums
    of squares of the change of impulse and of the impulse [N2 s2], the largest violation [m/s], how many were noted.
    """
    motion = workspace.motion
    changed, size, fastest = zeros(), zeros(), zeros()
    noted = noted_from
    for block in range(begin, begin + count):
        contact = contacts_of(contacts, block)
        i, j = gather(motion, blocks, block, 1), gather(motion, blocks, block, 2)
        x, y, z, violation = new_impulse(law, contact, i, j, broadcast(relaxation))
        dx, dy, dz = x - contact[3], y - contact[4], z - contact[5]
        push(motion, blocks, block, contact, i, j, dx, dy, dz)
        store(contacts, block, 3, x)
        store(contacts, block, 4, y)
        store(contacts, block, 5, z)
        if law.rolling > 0.0:
            sweep_couples(blocks, contacts, block, law, broadcast(relaxation), workspace)
        moved = dx * dx + dy * dy + dz * dz
        lively = greater_bits(moved, broadcast(quiet)) | greater_bits(violation, broadcast(calm))
        if lively:
            for lane in range(WIDTH):
                # a spare row of this slab takes what is not noted: two threads would write a common one
                rows[0, 0, lane] = spare
                if lively >> lane & 1:
                    rows[0, 0, lane] = noted
                    workspace.lively[noted] = blocks[block, 0, lane]
                    for side in range(2):
                        workspace.bodies[noted, side] = blocks[block, 1 + side, lane]
                    noted += 1
            nx, ny, nz = contact[:3]
            scatter(workspace.noted, rows, 0, 0, (nx, ny, nz, x, y, z, contact[6], contact[7]))
            if law.rolling > 0.0:
                couple = load(contacts, block, 8), load(contacts, block, 9), load(contacts, block, 10)
                scatter(workspace.noted_couples, rows, 0, 0, (*couple, nx, nx, nx, nx, nx))
        fastest = select_greater(violation, fastest, violation, fastest)
        changed = changed + moved
        size = size + (x * x + y * y + z * z)
    return total(changed), total(size), largest(fastest), noted - noted_from


@compiled_for_teams
def guide_wall(motion, wall, drive, push):
    """Move a body between rails along z, no faster down than its drive; gives the new impulse [N s].

    Its drive pushes it down with the impulse that this takes, but at most with drive[1] [N s], and pulls without limit.
    drive[0] is a velocity along z [m/s], negative downwards; a wall of infinite mass needs no drive.
    """
    inverse_mass = motion[wall, 3]
    if inverse_mass == 0.0:
        return push
    motion[wall, :2] = 0.0
    motion[wall, 4:7] = 0.0
    new = min(push + (motion[wall, 2] - drive[0]) / inverse_mass, drive[1])
    motion[wall, 2] -= inverse_mass * (new - push)
    return new


@compiled_for_teams
def push_blocks(contacts, motion, blocks, begin, count):
    """Give starting impulses of blocks begin to begin + count to bodies, and the sum of their squares [N2 s2]."""
    size = zeros()
    for block in range(begin, begin + count):
        contact = contacts_of(contacts, block)
        i, j = gather(motion, blocks, block, 1), gather(motion, blocks, block, 2)
        x, y, z = contact[3:6]
        push(motion, blocks, block, contact, i, j, x, y, z)
        size = size + (x * x + y * y + z * z)
    return total(size)


@compiled_for_teams
def sweep_slabs(part, slabs, workspace, law, relaxation, everyone, ends, quiet, calm, last_block, rows):
    """A sweep over every other slab of `part`, all contacts if `everyone`, else the copies of those noted.

    Notes contacts anew if `quiet` [N2 s2] or `calm` [m/s] is finite; where it `ends`, copies give their impulses back
    afterwards. All contacts of the last slab are with the last wall, which may yield.
    """
    account = workspace.account
    for s in range(part[0], part[1], 2):
        start, count, of_lively = slabs.begin[s], slabs.begin[s + 1] - slabs.begin[s], WIDTH * slabs.begin[s]
        blocks, contacts, spare = slabs.blocks, workspace.contacts, workspace.noted.shape[0] - 2 - s
        wall = ContactLaw(law.wall_friction, law.wall_friction, law.rolling)
        own = law if s < slabs.begin.shape[0] - 2 else wall
        if not everyone:
            blocks, contacts = workspace.lively_blocks, workspace.lively_contacts
            start, count = first_lively(of_lively), int(account[s, LIVELY_BLOCKS])
        changed, size, fastest, noted = sweep_blocks(
            blocks, contacts, start, count, of_lively, own, relaxation, quiet, calm, workspace, rows, spare
        )
        if ends and not everyone:
            give_back(start, count, workspace)
        if everyone:
            account[s, CHANGED], account[s, SIZE] = changed, size
            account[s, FASTEST] = fastest
        if quiet < np.inf or calm < np.inf:
            account[s, NOTED] = noted
            account[s, LIVELY_BLOCKS] = deal_lively(s, of_lively, noted, workspace, last_block)


@compiled_for_teams
def sweep_until(
    rank, members, barrier, slabs, workspace, law, drive, tolerance, calm, enough_sweeps, most_sweeps
):
    """Gauss-Seidel from the given impulses until their change is small; run by all members of a team.

    Sweeps run in rounds. The first of each visits all contacts and decides whether to end; the others visit those whose
    impulse then changed by more than `tolerance` of the root mean square impulse, or that closed faster than they may
    by more than `calm` [m/s]. Sweep AGAIN of a round leaves out those that no longer do. After `enough_sweeps` the
    tolerance is waived, `calm` never. Gives the number of all sweeps, and the relative change of the last full one.
    """
    begin, last = slabs.begin, slabs.begin.shape[0] - 2
    account, motion = workspace.account, workspace.motion
    last_block, rows = np.empty(motion.shape[0], np.int32), np.empty((1, 1, WIDTH), np.int32)
    parts, lively_parts = np.empty((3, 2), np.int64), np.empty((3, 2), np.int64)
    for kind in range(3):
        parts[kind] = part_of(rank, members, last, kind, np.diff(begin))
    contacts = 0
    for s in range(last + 1):
        contacts += int(account[s, COUNT])
    idle = 0 if account[last, COUNT] > 0.0 else 1  # the last body touches nothing
    for k in range(idle, 3):
        for s in range(parts[ORDER[k], 0], parts[ORDER[k], 1], 2):
            count = begin[s + 1] - begin[s]
            account[s, PUSHED] = push_blocks(workspace.contacts, motion, slabs.blocks, begin[s], count)
        barrier_wait(barrier, members)
    size = 0.0
    for s in range(last + 1 - idle):  # in one order, whoever pushed or swept them
        size += account[s, PUSHED]
    push = guide_wall(motion, workspace.wall, drive, 0.0) if rank == 0 else 0.0
    change = 0.0
    for sweep in range(most_sweeps):
        turn = sweep % ROUND
        everyone = turn == 0
        relaxation = 1.0 if everyone or turn == ROUND - 1 else RELAXATION
        ends = turn in (AGAIN, ROUND - 1) or sweep == most_sweeps - 1
        quiet, limit = np.inf, np.inf
        if turn in (0, AGAIN):
            quiet, limit = tolerance * tolerance * size / max(contacts, 1), calm
        if turn in (1, AGAIN + 1):  # since the contacts were noted, all have met
            for kind in range(3):
                lively_parts[kind] = part_of(rank, members, last, kind, account[:, LIVELY_BLOCKS])
        for k in range(idle, 3):
            part = parts[ORDER[k]] if everyone else lively_parts[ORDER[k]]
            sweep_slabs(
                part, slabs, workspace, law, relaxation, everyone, ends, quiet, limit, last_block, rows
            )
            barrier_wait(barrier, members)
        # no barrier: only the last slab, which is this member's, touches the wall
        if rank == 0:
            push = guide_wall(motion, workspace.wall, drive, push)
        if everyone:
            # each member adds the same numbers in the same order: all end with the same sweep, without asking
            changed, size, fastest = 0.0, 0.0, 0.0
            for s in range(last + 1 - idle):
                changed += account[s, CHANGED]
                size += account[s, SIZE]
                fastest = max(fastest, account[s, FASTEST])
            change = np.sqrt(changed / size) if size > 0.0 else 0.0
            if fastest < calm and (change < tolerance or sweep >= enough_sweeps):
                return sweep + 1, change
    return most_sweeps, change
