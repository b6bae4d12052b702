"""Pairs dealt into slabs upright in the layer, so that members of a team can work on them side by side.

The layer is cut into strips, each at least as wide as the two spheres of any pair are apart along the axis of strips.
So a pair lies in one strip or in two adjacent ones; it is counted to the first of them. Pairs of two strips of even
number then share no sphere, nor do pairs of two of odd number. A slab is some neighbours of the even strips, or of the
odd ones: contacts of a large sphere must stand in blocks one after another (blocks.py), which one strip alone
cannot fill. Slabs come from the positions alone and not from the number of threads.
Within a slab, pairs are taken from the top down. Neighbours in this order are mostly apart from each other in the
layer, so that few blocks hold them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from asphalt_nscd.nscd.compiled import compiled_for_teams
from asphalt_nscd.nscd.lanes import WIDTH, aligned
from asphalt_nscd.nscd.spheres.laws import FORCE, WITH_COUPLE
from asphalt_nscd.nscd.team import Team, barrier_wait, mark_started, partition

MOST_SLABS = 256
LAYER = 5e-4  # m, within which pairs stand in the order of the list
MOST_LAYERS = 1000
FAIR = 4  # a multiple of it: as many slabs of even number as of odd, and equal parts for two threads
# contacts of a large sphere need a block each: one strip alone filled 6.7 lanes of eight
STRIPS = 3  # of one slab, at least: blocks are then nearly full


class Slabs(NamedTuple):
    """Pairs of spheres in the order of slabs, and of blocks in each (blocks.py).

    Slab s holds blocks begin[s]:begin[s + 1]; the slab after the last one holds the pairs with the last body.
    Contact k stands in block k // 8, lane k % 8.
    """

    begin: np.ndarray  # (slabs + 2,)
    blocks: np.ndarray  # (b, 3, 8) contacts, first bodies, second bodies: rows of Workspace.motion
    pair: np.ndarray  # (8 b,) place of each contact in the list of pairs; -1 where a lane is left over


class Workspace(NamedTuple):
    """Arrays that a step works in: contacts (c,), blocks (b,), bodies and their rows (r,), see `private_rows`.

    `contacts` has three rows more where a law has a couple, which starts each step from zero. What starts the next step
    is carried as impulses are (`granular.lay_in`, `granular.take_out`, `neighbours.carry_reactions`).
    """

    motion: np.ndarray  # (r, 8) velocity [m/s], 1/mass [1/kg], spin as surface velocity [m/s], 5/2 of 1/mass
    place: np.ndarray  # (r, 8) [m] of a sphere: position, radius, zeros; of a plane: a point, 0, normal, 1
    contacts: (
        np.ndarray
    )  # (b, 8 or 11, 8) normal, impulse [N s], target [m/s], mass [kg] it moves; couple [N m s]
    lively: np.ndarray  # (c,) contacts that were noted
    noted: np.ndarray  # (c + slabs + 2, 8) what `contacts` has of each; a spare row for each slab; zeros
    noted_couples: np.ndarray  # (c + slabs + 2, 8) the rest of it; one row where there is none
    bodies: np.ndarray  # (c, 2) of the noted contacts
    lively_blocks: np.ndarray  # (2 b, 3, 8) in which noted contacts stand; see `first_lively`
    lively_contacts: np.ndarray  # (2 b, 8 or 11, 8) copies of them
    block: np.ndarray  # (c,) while contacts are dealt: where each stands,
    lane: np.ndarray  # (c,)
    filled: np.ndarray  # (c,) lanes of each block that are taken,
    following: np.ndarray  # (c,) the next block that may have room,
    account: np.ndarray  # (slabs + 1, 8) see gauss_seidel.py
    wall: int  # row of the last body
    planes: int  # it and those before it


def workspace_for(contacts: int, bodies: int, planes: int, numbers: int = FORCE) -> Workspace:
    """Workspace of zeros for a step; planes count among `bodies`; `numbers` of a contact, FORCE or WITH_COUPLE."""
    rows, blocks, noted = (
        bodies + (MOST_SLABS + 1) * (planes + 1),
        -(-contacts // WIDTH),
        contacts + MOST_SLABS + 2,
    )
    lively, block, lane, filled, following = np.empty((5, contacts), np.int32)
    return Workspace(
        motion=aligned((rows, WIDTH)),
        place=aligned((rows, WIDTH)),
        contacts=aligned((blocks, numbers, WIDTH)),
        lively=lively,
        noted=aligned((noted, WIDTH)),
        noted_couples=aligned((noted if numbers == WITH_COUPLE else 1, WIDTH)),
        bodies=np.empty((contacts, 2), np.int32),
        lively_blocks=np.empty((2 * blocks, 3, WIDTH), np.int32),
        lively_contacts=aligned((2 * blocks, numbers, WIDTH)),
        block=block,
        lane=lane,
        filled=filled,
        following=following,
        account=aligned((MOST_SLABS + 1, WIDTH)),
        wall=bodies - 1,
        planes=planes,
    )


@compiled_for_teams
def private_rows(s, workspace):
    """Rows of slab `s` alone, so that no two threads write to one.

    A body that stays zero, for lanes left over, and the slab's copy of the first plane, which the others follow.
    """
    body = workspace.wall + 1 + s * (workspace.planes + 1)
    return body, body + 1


def slabs_of(
    team: Team, position: np.ndarray, start: np.ndarray, other: np.ndarray, last_body: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The pairs of a list in slabs along the longer horizontal axis, from the top down in each.

    Returns the first pair of each slab (slabs + 2,), the places in the list (c,) and the bodies (c, 2) of pairs;
    `last_body` is the body that all may touch.
    """
    n, pairs = position.shape[0], other.shape[0]
    pair, bodies = np.empty(pairs, np.int32), np.empty((pairs, 2), np.int32)
    if n == 0:
        return np.zeros(3, np.int64), pair, bodies
    shares = np.append(np.searchsorted(start[:n], np.arange(team.members) * pairs // team.members), n)
    shares[0] = 0
    found = np.array(team.run(_measure, shares, position, start, other))
    low, extent = found[:, 0].min(axis=0), found[:, 1].max(axis=0) - found[:, 0].min(axis=0)
    axis = int(extent[1] > extent[0])
    apart = found[:, 2, axis].max() * (1.0 + 1e-9)  # rounding must not narrow them
    strips = int(np.clip(extent[axis] / apart, 1.0, MOST_SLABS)) if apart > 0.0 else 1
    slabs = strips
    if strips > FAIR:
        strips = strips // FAIR * FAIR
        slabs = max(FAIR, strips // STRIPS // FAIR * FAIR)
    layers = int(min(extent[2] / LAYER + 1.0, MOST_LAYERS))
    strip, layer = np.empty(n, np.int32), np.empty(pairs, np.int32)
    place = np.zeros((team.members, (slabs + 1) * layers), np.int64)
    begin = np.empty(slabs + 2, np.int64)
    box = axis, low[axis], extent[axis], low[2] + extent[2], strips, last_body
    team.run(_deal, shares, position, start, other, box, strip, layer, place, begin, pair, bodies)
    return begin, pair, bodies


@compiled_for_teams
def _measure(rank, members, barrier, shares, position, start, other):
    """Least and most of each coordinate in a share of spheres (two rows); how far pairs are apart along x and y."""
    mark_started(barrier)
    found = np.empty((3, 3))
    found[0], found[1], found[2] = np.inf, -np.inf, 0.0
    n = position.shape[0]
    for i in range(shares[rank], shares[rank + 1]):
        for k in range(3):
            found[0, k], found[1, k] = min(found[0, k], position[i, k]), max(found[1, k], position[i, k])
        for c in range(start[i], start[i + 1]):
            if other[c] < n:
                for k in range(2):
                    found[2, k] = max(found[2, k], abs(position[other[c], k] - position[i, k]))
    return found


@compiled_for_teams
def _deal(
    rank, members, barrier, shares, position, start, other, box, strip, layer, place, begin, pair, bodies
):
    """Deal pairs into layers of slabs, in the order of the list in each; place (members, (slabs + 1) layers): zeros."""
    mark_started(barrier)
    axis, low, extent, top, strips, last_body = box
    n, slabs = position.shape[0], begin.shape[0] - 2
    layers = place.shape[1] // (slabs + 1)
    for i in range(shares[rank], shares[rank + 1]):
        strip[i] = min(int((position[i, axis] - low) / extent * strips), strips - 1) if strips > 1 else 0
    barrier_wait(barrier, members)
    for i in range(shares[rank], shares[rank + 1]):
        for c in range(start[i], start[i + 1]):
            j = other[c]
            s = min(strip[i], strip[j]) if j < n else strip[i]
            # several strips of one kind, even or odd, make a slab of that kind
            s = slabs if j == last_body else s // 2 * slabs // strips * 2 + s % 2 if strips > slabs else s
            height = 0.5 * (position[i, 2] + position[j, 2]) if j < n else position[i, 2]
            layer[c] = s * layers + min(int((top - height) / LAYER), layers - 1)
            place[rank, layer[c]] += 1
    barrier_wait(barrier, members)
    if rank == 0:
        following = 0
        for at in range(place.shape[1]):
            if at % layers == 0:
                begin[at // layers] = following
            # members hold the list in order, so a layer keeps the order of the list, however many share it
            for member in range(members):
                count = place[member, at]
                place[member, at] = following
                following += count
        begin[slabs + 1] = following
    barrier_wait(barrier, members)
    for i in range(shares[rank], shares[rank + 1]):
        for c in range(start[i], start[i + 1]):
            at = place[rank, layer[c]]
            pair[at] = c
            bodies[at, 0], bodies[at, 1] = i, other[c]
            place[rank, layer[c]] += 1


@compiled_for_teams
def first_and_end(rank, members, slabs, kind):
    """What a member sweeps: slabs first, first + 2, ... before `end`.

    `kind` is 0 for slabs of even number, 1 for odd; 2 is the slab of the last body, which the first member sweeps.
    """
    if kind == 2:
        return slabs, slabs + (1 if rank == 0 else 0)
    begin, end = partition(rank, members, (slabs - kind + 1) // 2)
    return kind + 2 * begin, kind + 2 * end


@compiled_for_teams
def part_of(rank, members, slabs, kind, work):
    """What a member sweeps: slabs first, first + 2, ... before `end`, with parts of about equal `work` (slabs,).

    A slab is of the member in whose equal share of the sum of the work its middle lies; `kind` as in `first_and_end`.
    """
    if kind == 2:
        return first_and_end(rank, members, slabs, kind)
    total = 0.0
    # few slabs hold most of the lively contacts: equal numbers of slabs would be unequal work
    for s in range(kind, slabs, 2):
        total += work[s]
    first = end = kind
    before = 0.0
    for s in range(kind, slabs, 2):
        middle = (before + 0.5 * work[s]) * members
        first += 2 * (middle < rank * total)
        end += 2 * (middle < (rank + 1) * total or rank == members - 1)  # the last one takes empty slabs, too
        before += work[s]
    return first, end
