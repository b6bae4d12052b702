"""Blocks of bonds that share no body: what lanes of the processor may take at once."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds.gauss_seidel import _blocks

NOBODY = 60


def blocks_of(bodies, width=8, window=64):
    return _blocks(np.array(bodies), NOBODY, width, window)


@pytest.fixture(scope="module")
def network():
    """400 bonds in ascending order between 60 bodies; of some, the first end stands still."""
    rng = np.random.default_rng(5)
    pairs = np.sort([rng.choice(NOBODY, 2, replace=False) for _ in range(400)], axis=1)
    pairs[rng.random(400) < 0.05, 0] = NOBODY
    return pairs[np.lexsort(pairs.T[::-1])]


def test_every_bond_stands_in_one_lane(network):
    blocks = blocks_of(network)
    np.testing.assert_array_equal(np.sort(blocks[blocks >= 0]), np.arange(len(network)))


def test_no_block_holds_a_body_twice(network):
    for block in blocks_of(network):
        bodies = network[block[block >= 0]].ravel()
        moving = bodies[bodies != NOBODY]
        assert np.unique(moving).size == moving.size


def test_what_stands_still_may_be_in_all_lanes():
    pairs = [(NOBODY, body) for body in range(16)]
    np.testing.assert_array_equal(blocks_of(pairs), np.arange(16).reshape(2, 8))


def test_bonds_keep_nearly_their_order(network):
    """No bond comes before one that stands a window ahead of it."""
    blocks = blocks_of(network, window=40)
    visits = blocks[blocks >= 0]
    latest = np.maximum.accumulate(visits)
    assert (latest - visits).max() > 0
    for place, bond in enumerate(visits):
        assert bond < place + 40


def test_a_chain_of_one_body_takes_a_block_a_bond():
    blocks = blocks_of([(0, other) for other in range(1, 6)])
    np.testing.assert_array_equal(blocks[:, 0], np.arange(5))
    assert (blocks[:, 1:] == -1).all()
