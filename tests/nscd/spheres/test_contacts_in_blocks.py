"""Blocks share no body and keep the order of each; sweeps block by block are those of contacts one by one."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import blocks_in_order, sweep_one_by_one

from asphalt_nscd.nscd.lanes import WIDTH
from asphalt_nscd.nscd.spheres.blocks import deal_blocks, deal_lively, first_lively, give_back, number_blocks
from asphalt_nscd.nscd.spheres.gauss_seidel import sweep_blocks
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.spheres.slabs import private_rows, workspace_for
from asphalt_nscd.nscd.team import Team

SPHERES, PLANES = 60, 3
BODIES = SPHERES + PLANES  # two fixed planes and a wall


def some_contacts(count, spheres=SPHERES, seed=1):
    """(count, 2): of two spheres, of a sphere and a plane or the wall."""
    rng = np.random.default_rng(seed)
    first = rng.integers(0, spheres, count)
    second = (first + rng.integers(1, spheres, count)) % spheres
    to_plane = rng.random(count) < 0.2
    second[to_plane] = rng.integers(SPHERES, BODIES, to_plane.sum())
    return np.stack([first, second], axis=1).astype(np.int32)


@pytest.mark.parametrize("count", [0, 1, 40, 300])
def test_blocks_are_those_of_the_naive_twin(count):
    """In the middle of a longer list."""
    workspace, bodies = workspace_for(400, BODIES, PLANES), some_contacts(320)
    bodies[:, 1] = np.where(
        bodies[:, 1] >= SPHERES, bodies[:, 1] + 50, bodies[:, 1]
    )  # as rows that do not yield
    found = number_blocks(bodies, 10, count, SPHERES, workspace, np.empty(len(workspace.motion), np.int32))
    expected = blocks_in_order(bodies[10 : 10 + count], SPHERES)
    assert found == len(expected)
    for block, contacts in enumerate(expected):
        np.testing.assert_array_equal(workspace.block[10:][contacts], block)
        np.testing.assert_array_equal(workspace.lane[10:][contacts], np.arange(len(contacts)))
    assert count < 300 or count / found > 0.8 * WIDTH


@pytest.mark.parametrize("members", [1, 2, 3])
def test_each_slab_is_dealt_by_itself(members):
    """Every pair once; planes as rows of the slab alone, the wall as the only one; lanes left over name nobody."""
    bodies = some_contacts(200)
    pair, begin = np.random.default_rng(2).permutation(200).astype(np.int32), np.array([0, 70, 70, 160, 200])
    with Team(members) as team:
        slabs, workspace = deal_blocks(team, begin, pair, bodies, workspace_for(0, BODIES, PLANES))
    assert workspace.block.size >= slabs.pair.size == WIDTH * slabs.begin[-1]
    rows = []
    for s in range(4):
        nobody, plane = private_rows(s, workspace)
        rows += [nobody, *range(plane, plane + PLANES)]
        mine = bodies[begin[s] : begin[s + 1]].copy()
        fixed = (mine[:, 1] >= SPHERES) & (mine[:, 1] < BODIES - 1)
        mine[fixed, 1] += plane - SPHERES
        expected = blocks_in_order(mine, BODIES)
        assert slabs.begin[s + 1] - slabs.begin[s] == len(expected)
        for block, contacts in enumerate(expected, slabs.begin[s]):
            lanes, size = np.arange(WIDTH * block, WIDTH * (block + 1)), len(contacts)
            np.testing.assert_array_equal(slabs.blocks[block, 0], lanes)
            np.testing.assert_array_equal(slabs.blocks[block, 1:, :size].T, mine[contacts])
            np.testing.assert_array_equal(slabs.blocks[block, 1:, size:], nobody)
            np.testing.assert_array_equal(slabs.pair[lanes[:size]], pair[begin[s] :][contacts])
            np.testing.assert_array_equal(slabs.pair[lanes[size:]], -1)
    assert len(set(rows)) == len(rows)
    assert min(rows) == BODIES
    assert max(rows) < len(workspace.motion)


def some_room(bodies, seed):
    """(Slabs, Workspace) of contacts of all kinds, sticking, slipping, open; bodies of many masses, the wall heavy."""
    rng, count = np.random.default_rng(seed), len(bodies)
    begin = np.array([0, count, count])
    slabs, workspace = deal_blocks(
        Team(), begin, np.arange(count, dtype=np.int32), bodies, workspace_for(0, BODIES, PLANES)
    )
    workspace.motion[:BODIES, [0, 1, 2, 4, 5, 6]] = rng.normal(size=(BODIES, 6))
    workspace.motion[:BODIES, 3] = rng.uniform(0.1, 3.0, BODIES)
    workspace.motion[SPHERES : BODIES - 1] = 0.0
    workspace.motion[:BODIES, 7] = 2.5 * workspace.motion[:BODIES, 3]
    plane = private_rows(0, workspace)[1]
    workspace.motion[plane : plane + PLANES] = workspace.motion[SPHERES:BODIES]
    used = np.flatnonzero(slabs.pair >= 0)
    normal = rng.normal(size=(count, 3))
    rows = np.zeros((len(slabs.pair), 8))
    rows[used, :3] = normal / np.linalg.norm(normal, axis=1)[:, None]
    rows[used, 3:6] = rows[used, :3] * rng.choice([0.0, 1.0, 3.0], count)[:, None]
    rows[used, 6] = rng.normal(-0.3, 1.0, count)
    rows[used, 7] = 1.0 / workspace.motion[bodies[slabs.pair[used]], 3].sum(axis=1)
    workspace.contacts[: slabs.begin[-1]] = rows.reshape(-1, WIDTH, 8).transpose(0, 2, 1)
    return slabs, workspace


def rows_of(workspace):
    """(c, 8) of each contact."""
    return workspace.contacts.transpose(0, 2, 1).reshape(-1, 8)


@pytest.mark.parametrize("relaxation", [1.0, 1.5])
def test_sweeps_block_by_block_are_those_one_by_one(relaxation):
    """Bit for bit: impulses, motion and what is noted, over all and over those noted; sums to rounding."""
    bodies = some_contacts(300)
    slabs, workspace = some_room(bodies, 3)
    contact = np.argsort(slabs.pair)[-300:]  # of each pair
    packed, motion = rows_of(workspace)[contact], workspace.motion[:BODIES].copy()
    last, room = np.empty(len(workspace.motion), np.int32), np.empty((1, 1, WIDTH), np.int32)
    blocks, contacts, begin, count, visits = slabs.blocks, workspace.contacts, 0, slabs.begin[1], range(300)
    spare = len(workspace.noted) - 2
    for quiet, calm in ((0.3, np.inf), (np.inf, 0.5)):
        workspace.noted[:-1] = 7.0
        *sums, noted = sweep_blocks(
            blocks,
            contacts,
            begin,
            count,
            8,
            ContactLaw(0.3, 0.3),
            relaxation,
            quiet,
            calm,
            workspace,
            room,
            spare,
        )
        others = np.delete(workspace.noted[:-1], [*range(8, 8 + noted), spare], axis=0)
        assert (others == 7.0).all()  # they may be those of another thread
        if contacts is workspace.lively_contacts:
            give_back(begin, count, workspace)
        *expected, lively, kinds = sweep_one_by_one(
            bodies, packed, motion, 0.3, visits, relaxation, quiet, calm
        )
        np.testing.assert_array_equal(rows_of(workspace)[contact], packed)
        np.testing.assert_array_equal(workspace.motion[:BODIES], motion)
        assert not np.delete(rows_of(workspace), contact, axis=0).any()
        np.testing.assert_allclose(sums, expected, rtol=1e-13)
        found = slabs.pair[workspace.lively[8 : 8 + noted]]
        assert sorted(found) == sorted(lively)
        np.testing.assert_array_equal(bodies[found, 0], workspace.bodies[8 : 8 + noted, 0])
        assert 20 < noted < len(visits) - 20
        assert min(kinds.values()) > 10
        blocks, contacts, begin = workspace.lively_blocks, workspace.lively_contacts, first_lively(8)
        count = deal_lively(0, 8, noted, workspace, last)
        visits = found.tolist()
    own = private_rows(0, workspace)[0]
    assert not workspace.motion[own].any()
    np.testing.assert_array_equal(workspace.motion[own + 1 : own + 3], motion[SPHERES : SPHERES + 2])


@pytest.mark.parametrize("spheres", [4, 60])
def test_some_contacts_need_at_most_twice_the_blocks_of_all(spheres):
    """The room that copies have (first_lively): few bodies make long chains, many fill the blocks."""
    rng, workspace = np.random.default_rng(7), workspace_for(400, BODIES, PLANES)
    bodies, last = some_contacts(320, spheres), np.empty(len(workspace.motion), np.int32)
    of_all = number_blocks(bodies, 0, 320, BODIES, workspace, last)
    for share in rng.uniform(0.05, 1.0, 200):
        some = bodies[rng.random(320) < share]
        assert number_blocks(some, 0, len(some), BODIES, workspace, last) <= 2 * of_all
