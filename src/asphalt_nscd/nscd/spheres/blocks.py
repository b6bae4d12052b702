"""Contacts in blocks of eight that share no body, so that the processor computes those of a block at once (lanes.py).

A contact comes into a block after those of all earlier contacts that share a body with it. Contacts of a body so
keep their order: block by block, sweeps give the same numbers as one by one. A block that is not full holds, in the
lanes left over, contacts without impulse or mass, of a body that stays zero.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled_for_teams
from asphalt_nscd.nscd.lanes import WIDTH, gather, store
from asphalt_nscd.nscd.spheres.laws import FORCE
from asphalt_nscd.nscd.spheres.slabs import Slabs, Workspace, first_and_end, private_rows, workspace_for
from asphalt_nscd.nscd.team import Team, barrier_wait, mark_started

NO_CONTACT = -1  # in a lane left over


@compiled_for_teams
def number_blocks(bodies, begin, count, fixed, workspace, last):
    """Deal contacts begin to begin + count into blocks, numbered from zero, and give how many there are.

    workspace.block and workspace.lane then hold where each stands. In `bodies` (c, 2) the first one yields; those from
    `fixed` on do not, so that contacts of a block may share them. `last` (r,) is for the last block of each body.
    """
    filled, following = workspace.filled, workspace.following
    for k in range(begin, begin + count):
        last[bodies[k, 0]] = last[bodies[k, 1]] = -1
    found = 0
    for k in range(begin, begin + count):
        i, j = bodies[k, 0], bodies[k, 1]
        block = max(last[i], last[j]) + 1
        while block < found and filled[begin + block] == WIDTH:
            after = following[begin + block]
            if after < found and filled[begin + after] == WIDTH:
                following[begin + block] = following[begin + after]  # next time, fewer full ones to pass by
            block = after
        at = begin + block
        if block == found:
            found += 1
            filled[at], following[at] = 0, found
        workspace.block[k], workspace.lane[k] = block, filled[at]
        filled[at] += 1
        last[i] = block
        if j < fixed:
            last[j] = block
    return found


@compiled_for_teams
def deal_lively(s, begin, count, workspace, last):
    """Deal the `count` contacts noted in slab `s` from `begin` on into lively blocks, and give their number.

    A sweep over copies side by side is faster than one that looks for the contacts where they stand.
    """
    blocks, copies = workspace.lively_blocks, workspace.lively_contacts
    found = number_blocks(workspace.bodies, begin, count, workspace.wall + 1, workspace, last)
    nobody, start = private_rows(s, workspace)[0], first_lively(begin)
    # the last row stays zero: lanes left over read their contact from it
    no_contact = workspace.noted.shape[0] - 1
    for block in range(start, start + found):
        for lane in range(WIDTH):
            blocks[block, 0, lane] = no_contact
            blocks[block, 1, lane] = blocks[block, 2, lane] = nobody
    for k in range(begin, begin + count):
        block, lane = start + workspace.block[k], workspace.lane[k]
        blocks[block, 0, lane] = k
        blocks[block, 1, lane], blocks[block, 2, lane] = workspace.bodies[k, 0], workspace.bodies[k, 1]
    for block in range(start, start + found):
        x, y, z, px, py, pz, target, mass = gather(workspace.noted, blocks, block, 0)
        store(copies, block, 0, x)
        store(copies, block, 1, y)
        store(copies, block, 2, z)
        store(copies, block, 3, px)
        store(copies, block, 4, py)
        store(copies, block, 5, pz)
        store(copies, block, 6, target)
        store(copies, block, 7, mass)
        if copies.shape[1] > FORCE:
            x, y, z = gather(workspace.noted_couples, blocks, block, 0)[:3]
            store(copies, block, 8, x)
            store(copies, block, 9, y)
            store(copies, block, 10, z)
        for lane in range(WIDTH):
            k = blocks[block, 0, lane]
            blocks[block, 0, lane] = workspace.lively[k] if k != no_contact else NO_CONTACT
    return found


@compiled_for_teams
def first_lively(begin):
    """Place in workspace.lively_blocks of the first one of the slab whose contacts begin at `begin`.

    The longest chain of contacts that share bodies, and full blocks, decide how many blocks there must be. A part of a
    slab's contacts has no more of either than all of them, so that twice the number of the slab's blocks is enough.
    """
    return begin // WIDTH * 2


@compiled_for_teams
def give_back(start, count, workspace):
    """Bring impulses [N s] of lively blocks start to start + count back to their contacts."""
    blocks, copies, contacts = workspace.lively_blocks, workspace.lively_contacts, workspace.contacts
    for block in range(start, start + count):
        for lane in range(WIDTH):
            contact = blocks[block, 0, lane]
            if contact != NO_CONTACT:
                for k in range(3, 6):
                    contacts[contact // WIDTH, k, contact % WIDTH] = copies[block, k, lane]
                for k in range(FORCE, contacts.shape[1]):
                    contacts[contact // WIDTH, k, contact % WIDTH] = copies[block, k, lane]


def deal_blocks(
    team: Team, begin: np.ndarray, pair: np.ndarray, bodies: np.ndarray, workspace: Workspace
) -> tuple[Slabs, Workspace]:
    """Pairs in the order of slabs, dealt into blocks by a team, with a workspace that fits them.

    `begin` (slabs + 2,), `pair` (c,) and `bodies` (c, 2) are those of `slabs_of`.
    """
    sizes = workspace.wall + 1, workspace.planes, workspace.contacts.shape[1]
    if workspace.block.size < pair.size:
        # a quarter more, so that lists which grow step by step do not ask for new arrays each time
        workspace = workspace_for(pair.size + pair.size // 4, *sizes)
    rows, counts = np.empty_like(bodies), np.empty(begin.size - 1, np.int64)
    team.run(_number_slabs, begin, bodies, rows, counts, workspace)
    first_block = np.concatenate([[0], counts]).cumsum()
    blocks, contacts = first_block[-1], first_block[-1] * WIDTH
    slabs = Slabs(first_block, np.empty((blocks, 3, WIDTH), np.int32), np.full(contacts, -1, np.int32))
    team.run(_fill_slabs, begin, pair, rows, slabs, workspace)
    if workspace.block.size < contacts:
        workspace = workspace_for(contacts + contacts // 4, *sizes)
    return slabs, workspace


@compiled_for_teams
def _number_slabs(rank, members, barrier, begin, bodies, rows, counts, workspace):
    """Deal contacts of this member's slabs into `counts` blocks each; planes in `rows` (c, 2) are the slab's own."""
    mark_started(barrier)
    last, first_plane = begin.shape[0] - 2, workspace.wall + 1 - workspace.planes
    # each member's own: in one array members would take cache lines from each other
    last_block = np.empty(workspace.motion.shape[0], np.int32)
    for kind in range(3):
        first, end = first_and_end(rank, members, last, kind)
        for s in range(first, end, 2):
            own = private_rows(s, workspace)[1] - first_plane
            for k in range(begin[s], begin[s + 1]):
                i, j = bodies[k, 0], bodies[k, 1]
                rows[k, 0], rows[k, 1] = i, j if j < first_plane or j == workspace.wall else j + own
            counts[s] = number_blocks(
                rows, begin[s], begin[s + 1] - begin[s], workspace.wall + 1, workspace, last_block
            )
        barrier_wait(barrier, members)


@compiled_for_teams
def _fill_slabs(rank, members, barrier, begin, pair, rows, slabs, workspace):
    """Write the contacts of this member's slabs to their lanes; lanes left over hold the body that stays zero."""
    mark_started(barrier)
    last = begin.shape[0] - 2
    for kind in range(3):
        first, end = first_and_end(rank, members, last, kind)
        for s in range(first, end, 2):
            nobody = private_rows(s, workspace)[0]
            for block in range(slabs.begin[s], slabs.begin[s + 1]):
                for lane in range(WIDTH):
                    slabs.blocks[block, 0, lane] = WIDTH * block + lane
                    slabs.blocks[block, 1, lane] = slabs.blocks[block, 2, lane] = nobody
            for k in range(begin[s], begin[s + 1]):
                block, lane = slabs.begin[s] + workspace.block[k], workspace.lane[k]
                slabs.blocks[block, 1, lane], slabs.blocks[block, 2, lane] = rows[k, 0], rows[k, 1]
                slabs.pair[WIDTH * block + lane] = pair[k]
