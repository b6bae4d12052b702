"""Slabs: every pair once, no sphere in two slabs of one kind, and motion that no number of threads changes."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.spheres.neighbours import find_pairs
from asphalt_nscd.nscd.spheres.slabs import part_of, slabs_of
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice

FAIR, LAYER, MOST_SLABS, STRIPS = 4, 5e-4, 256, 3  # stated again: all published layers rest on them
WALLS = np.zeros((2, 3)), np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])


def dealt(position, radius, reach):
    """Slabs of all pairs, the second plane the last body, before they are dealt into blocks; the pairs themselves."""
    start, other = find_pairs(position, radius, *WALLS, reach)
    first = np.repeat(np.arange(radius.size), np.diff(start))
    begin, pair, bodies = slabs_of(Team(), position, start, other, radius.size + 1)
    with Team(3) as team:
        for one, three in zip((begin, pair, bodies), slabs_of(team, position, start, other, radius.size + 1)):
            np.testing.assert_array_equal(one, three)
    slabs = SimpleNamespace(begin=begin, pair=pair, first=bodies[:, 0], second=bodies[:, 1])
    return slabs, first, other


@pytest.mark.parametrize("size", [(0.2, 0.03, 0.03), (0.03, 0.2, 0.03), (0.03, 0.03, 0.2), (3e-3, 2e-3, 0.1)])
def test_slabs_of_one_kind_share_no_sphere(size):
    """Along x or y, whichever is longer; upright boxes have few slabs."""
    rng = np.random.default_rng(1)
    n = 800
    position, radius = rng.uniform(-1.0, 1.0, (n, 3)) * size, 1e-3 * rng.uniform(1.0, 3.0, n)
    slabs, first, other = dealt(position, radius, 1e-3)
    last = slabs.begin.size - 2
    np.testing.assert_array_equal(np.sort(slabs.pair), np.arange(other.size))
    np.testing.assert_array_equal(slabs.first, first[slabs.pair])
    np.testing.assert_array_equal(slabs.second, other[slabs.pair])
    number = np.repeat(np.arange(last + 1), np.diff(slabs.begin))
    np.testing.assert_array_equal(number == last, slabs.second == n + 1)
    for kind in range(2):
        owner = {}
        for s, i, j in zip(number, slabs.first, slabs.second):
            if s < last and s % 2 == kind:
                assert owner.setdefault(i, s) == s
                assert j >= n or owner.setdefault(j, s) == s
    height = position[:, 2]
    middle = np.where(
        slabs.second < n, height[slabs.first] + height[slabs.second % n], 2.0 * height[slabs.first]
    )
    layer = ((height.max() - 0.5 * middle) / LAYER).astype(int)
    for s in range(last + 1):  # from the top down, and within a layer in the order of the list
        inside = slice(slabs.begin[s], slabs.begin[s + 1])
        order = np.lexsort([slabs.pair[inside], layer[inside]])
        np.testing.assert_array_equal(order, np.arange(order.size))
    assert last < FAIR or last % FAIR == 0
    assert (last >= 8) == (max(size[:2]) == 0.2)
    if last >= 8:
        axis = int(np.argmax(size[:2]))
        middle = [position[slabs.first[number == s], axis].mean() for s in np.unique(number)[:-1]]
        assert (np.diff(middle[::2]) > 0).all() and (np.diff(middle[1::2]) > 0).all()


def test_pairs_across_one_whole_slab():
    """A row of spheres, each as far from the next as a slab is wide: rounding must not skip a slab."""
    for step in np.linspace(1.9e-3, 2.1e-3, 41):
        position = np.zeros((9, 3))
        position[:, 0] = step * np.arange(9)
        slabs, _, _ = dealt(position, np.full(9, 1e-3), 2e-4)
        turned, _, _ = dealt(position[::-1], np.full(9, 1e-3), 2e-4)
        np.testing.assert_array_equal(turned.begin, slabs.begin)
        last = slabs.begin.size - 2
        number = np.repeat(np.arange(last + 1), np.diff(slabs.begin))
        np.testing.assert_array_equal(
            number == last, slabs.second == 10
        )  # the sphere at the edge has a slab, too
        for kind in range(2):
            spheres = [
                set(slabs.first[number == s]) | set(slabs.second[number == s][slabs.second[number == s] < 9])
                for s in range(kind, last, 2)
            ]
            assert sum(map(len, spheres)) == len(set().union(*spheres))


def test_no_more_slabs_than_there_is_room_for():
    position = np.zeros((2, 3))
    position[1, :2] = 10.0, 1e-3
    both = np.concatenate([position, position + [1e-4, 1.5e-3, 0.0]])
    slabs, _, _ = dealt(both, np.full(4, 1e-3), 1e-5)
    assert slabs.begin.size - 2 == MOST_SLABS // STRIPS // FAIR * FAIR


@pytest.mark.parametrize("kind", [0, 1, 2])
@pytest.mark.parametrize("members", [1, 2, 3, 5])
def test_parts_have_about_equal_work(members, kind):
    """Each slab of a kind is swept once, whoever has how much; more than half a slab too much has nobody."""
    slabs, rng = 13, np.random.default_rng(5)
    for work in (rng.exponential(size=slabs), np.arange(slabs) ** 3.0, np.zeros(slabs)):
        parts = [range(*part_of(rank, members, slabs, kind, work), 2) for rank in range(members)]
        if kind == 2:
            assert [list(part) for part in parts] == [[slabs]] + [[]] * (members - 1)
            continue
        assert [s for part in parts for s in part] == list(range(kind, slabs, 2))
        for part in parts:
            assert work[part].sum() <= work[kind::2].sum() / members + work[kind::2].max() + 1e-12


def test_what_earlier_steps_left_in_the_room_does_not_count():
    """The slab of the lid, which no sphere touches, is not swept."""
    found = []
    for left in (0.0, 1e9):
        position, radius = random_lattice(
            np.array([2e-3, 4e-3]), np.array([80, 10]), (0.04, 0.014, 0.03), np.random.default_rng(3)
        )
        pile = GranularBed.spheres_in_box(position, radius, (0.04, 0.014, 0.03), 2600.0, ContactLaw(0.2, 0.2))
        for _ in range(60):
            pile.advance(PouringNumerics())
            impulse = pile.impulse
            for array in pile._workspace:
                if isinstance(array, np.ndarray):
                    array[:] = left
            pile._workspace.noted[-1] = 0.0  # of lanes left over
            pile.impulse = impulse
        found.append((pile.sweeps, pile.overlap, pile.position.tobytes()))
    assert found[0] == found[1]
