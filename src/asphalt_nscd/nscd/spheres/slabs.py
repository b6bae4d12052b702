"""Pairs dealt into slabs upright in the layer, so that members of a team can work on them side by side.

A slab is at least as wide as the two spheres of any pair are apart along the axis of slabs. So a pair lies in one slab
or in two adjacent ones; it is counted to the first of them. Pairs of two slabs of even number then share no
sphere, nor do pairs of two of odd number. The slabs come from the positions alone and not from the number of threads.
Within a slab, pairs stand from the top down. Neighbours in this order are mostly apart from each other in the layer,
so that a visit need not wait for the result of the one before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from asphalt_nscd.nscd.compiled import compiled, compiled_for_teams
from asphalt_nscd.nscd.team import share

MOST_SLABS = 256
LAYER = 5e-4  # m, within which pairs stand in the order of the list
MOST_LAYERS = 1000
FAIR = 4  # a multiple of it: as many slabs of even number as of odd, and equal parts for two threads


class Slabs(NamedTuple):
    """Pairs of spheres in the order of slabs, from the top down in each; slab s holds begin[s]:begin[s + 1].

    The slab after the last one holds the pairs with the last body.
    """

    begin: np.ndarray  # (slabs + 2,)
    pair: np.ndarray  # (c,) place in the list of pairs
    first: np.ndarray  # (c,)
    second: np.ndarray  # (c,)


class Room(NamedTuple):
    """Where the work of a step is done; contacts of a slab stand from its begin on."""

    motion: (
        np.ndarray
    )  # (bodies, 8) velocity [m/s], 1/mass [1/kg], spin as surface velocity [m/s], 5/2 of 1/mass
    bodies: np.ndarray  # (c, 2)
    packed: (
        np.ndarray
    )  # (c, 8) normal, impulse [N s], target [m/s], mass that an impulse along the normal moves [kg]
    active: np.ndarray  # (c,) places in the order of slabs of pairs that take part
    everyone: np.ndarray  # (c,) 0, 1, 2, ...
    lively: np.ndarray  # (c,) contacts that were noted
    account: np.ndarray  # (slabs + 1, 8) see gauss_seidel.py


def room_for(pairs: int, bodies: int) -> Room:
    """For so many pairs."""
    return Room(
        _lines(bodies),
        np.empty((pairs, 2), np.int32),
        _lines(pairs),
        np.empty(pairs, np.int32),
        np.arange(pairs, dtype=np.int32),
        np.empty(pairs, np.int32),
        _lines(MOST_SLABS + 1),
    )


def _lines(rows: int) -> np.ndarray:
    """(rows, 8) zeros, each row a cache line."""
    line = 64
    memory = np.zeros(8 * rows + 8)
    skipped = -memory.ctypes.data % line // memory.itemsize
    return memory[skipped : skipped + 8 * rows].reshape(rows, 8)


@compiled
def slabs_of(position, start, other, last_body):
    """The pairs of a list (start, other), see neighbours.py, in slabs along the longer horizontal axis of `position`.

    Returns begin, pair, first, second of `Slabs`.
    """
    n = position.shape[0]
    axis, low, extent = 0, 0.0, -1.0
    for k in range(2):
        least, most = np.inf, -np.inf
        for i in range(n):
            least, most = min(least, position[i, k]), max(most, position[i, k])
        if most - least > extent:
            axis, low, extent = k, least, most - least
    apart = 0.0
    for i in range(n):
        for c in range(start[i], start[i + 1]):
            if other[c] < n:
                apart = max(apart, abs(position[other[c], axis] - position[i, axis]))
    slabs = 1
    if apart > 0.0:
        width = apart * (1.0 + 1e-9)  # rounding must not narrow them
        slabs = int(min(max(extent / width, 1.0), 1.0 * MOST_SLABS))
        if slabs > FAIR:
            slabs = slabs // FAIR * FAIR
    slab = np.zeros(n, np.int32)
    if slabs > 1:
        for i in range(n):
            slab[i] = min(int((position[i, axis] - low) / extent * slabs), slabs - 1)
    top = position[:, 2].max() if n else 0.0
    bottom = position[:, 2].min() if n else 0.0
    layers = int(min((top - bottom) / LAYER + 1.0, 1.0 * MOST_LAYERS))
    counted = np.zeros((slabs + 1) * layers + 1, np.int64)
    layer = np.empty(other.shape[0], np.int32)
    for i in range(n):
        for c in range(start[i], start[i + 1]):
            j = other[c]
            s = slabs if j == last_body else min(slab[i], slab[j]) if j < n else slab[i]
            height = 0.5 * (position[i, 2] + position[j, 2]) if j < n else position[i, 2]
            layer[c] = s * layers + min(int((top - height) / LAYER), layers - 1)
            counted[layer[c] + 1] += 1
    next_place = np.cumsum(counted)
    begin = next_place[::layers].copy()
    pair = np.empty(other.shape[0], np.int32)
    first = np.empty(other.shape[0], np.int32)
    second = np.empty(other.shape[0], np.int32)
    for i in range(n):
        for c in range(start[i], start[i + 1]):
            at = next_place[layer[c]]
            pair[at], first[at], second[at] = c, i, other[c]
            next_place[layer[c]] += 1
    return begin, pair, first, second


@compiled_for_teams
def first_and_end(rank, members, slabs, kind):
    """Slabs first, first + 2, ... before `end` are what a member sweeps of the even ones (kind 0) or odd ones (1).

    Kind 2 is the slab of the last body, which the first member sweeps.
    """
    if kind == 2:
        return slabs, slabs + (1 if rank == 0 else 0)
    begin, end = share(rank, members, (slabs - kind + 1) // 2)
    return kind + 2 * begin, kind + 2 * end
