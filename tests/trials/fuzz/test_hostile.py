"""Hostile packings: a few of the thousand that were tried, each of which ends in a result or one sentence."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from fuzz.hostile import hostile

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.spheres.neighbours import find_pairs

NONE = np.empty((0, 3))


@pytest.mark.parametrize(
    "seed", [*range(25), 440, 5183]
)  # bonds that leave a sphere free, cells that overlap
def test_a_hostile_call_ends_in_a_result_or_a_sentence(seed):
    call = hostile(np.random.default_rng([seed, 56]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            call()
        except InputError as error:
            assert str(error).endswith(".")


def test_a_speck_of_dust_among_boulders_calls_for_no_more_cells_than_memory_holds():
    """By the smallest diameter a metre had 1e15 cells; pairs are the same."""
    position = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.5], [0.5, 0.0, 0.0]])
    radius = np.array([0.25, 0.25, 0.2500005, 5e-6])
    start, other = find_pairs(position, radius, NONE, NONE, 1e-6)
    assert np.diff(start).sum() == 1 and set(
        [int(np.repeat(np.arange(4), np.diff(start))[0]), int(other[0])]
    ) == {1, 2}
