"""The random lattice: nobody overlaps, nobody sticks out, everybody is there."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import all_pairs

from asphalt_nscd.specimen.lattice import random_lattice

MIXES = {
    "alone": ([4e-3, 6e-3], [30, 25], (0.03, 0.02, 0.08)),  # none fits an octant of a 6 mm cell
    "sharing": ([2e-3, 3e-3, 6e-3, 4e-2], [150, 60, 30, 0], (0.03, 0.021, 0.06)),  # of the largest size none
    "one size": ([2e-3], [100], (0.01, 0.01, 0.01)),
    "crowded": ([2e-3, 4e-3], [8 * 20, 4], (0.008, 0.012, 0.016)),  # the last octant is taken
}


def strewn(mix, seed=1):
    return random_lattice(
        np.array(MIXES[mix][0]), np.array(MIXES[mix][1]), MIXES[mix][2], np.random.default_rng(seed)
    )


@pytest.mark.parametrize("mix", MIXES)
def test_spheres_are_apart_inside_and_complete(mix):
    diameters, counts, box = MIXES[mix]
    position, radius = strewn(mix)
    none = np.empty((0, 3))
    assert all_pairs(position, radius, none, none, -1e-12) == []
    assert (position - radius[:, None] >= -1e-12).all()
    assert (position + radius[:, None] <= np.array(box) + 1e-12).all()
    for diameter, count in zip(diameters, counts):
        assert (radius == diameter / 2).sum() == count
    assert radius.size == sum(counts)
    assert (np.diff(position[:, 2]) >= 0).all()  # ordered by height


def test_a_seed_stands_for_one_lattice():
    first, again, other = strewn("sharing", 7), strewn("sharing", 7), strewn("sharing", 8)
    diameters, counts, box = MIXES["sharing"]
    reversed_sizes = random_lattice(diameters[::-1], counts[::-1], box, np.random.default_rng(7))
    for one, two, three in zip(first, again, reversed_sizes):
        np.testing.assert_array_equal(one, two)
        np.testing.assert_array_equal(one, three)
    assert np.abs(first[0] - other[0]).max() > 1e-3


def test_sizes_and_places_are_mixed():
    """No size sits by preference at one end of the box: mean heights within three standard errors."""
    position, radius = strewn("sharing", 3)
    height = position[:, 2] / 0.06
    for size in np.unique(radius):
        own = height[radius == size]
        assert abs(own.mean() - 0.5) < 3 * np.sqrt(1 / 12 / own.size)


def test_small_spheres_are_dealt_evenly_and_lie_anywhere_in_their_octants():
    """210 spheres in the 120 cells of 150 that no large one has: two in 90 of them, one in the rest."""
    position, radius = strewn("sharing", 3)
    size = np.array(MIXES["sharing"][2]) / [5, 3, 10]
    cell, small = (position / size).astype(int) @ [1, 5, 15], radius < 3e-3
    assert np.bincount(np.bincount(cell[small], minlength=150)).tolist() == [30, 30, 90]
    assert not set(cell[small]) & set(cell[~small])
    share = (position[radius == 1e-3] % (size / 2) - 1e-3) / (size / 2 - 2e-3)
    np.testing.assert_allclose(share.mean(axis=0), 0.5, atol=3 * np.sqrt(1 / 12 / len(share)))
    np.testing.assert_allclose(share.std(axis=0), np.sqrt(1 / 12), rtol=0.1)
