"""The cell list against a look at all pairs, and reactions carried from list to list."""

from __future__ import annotations

import numpy as np
import pytest
from naive.granular import all_pairs

from asphalt_nscd.nscd.spheres.neighbours import (
    Reach,
    carry_reactions,
    closing_speeds,
    find_pairs,
    find_pairs_within,
    moved_beyond,
    speeds,
)
from asphalt_nscd.nscd.team import Team

NO_PLANES = np.empty((0, 3))


def listed(start, other):
    return list(zip(np.repeat(np.arange(start.size - 1), np.diff(start)).tolist(), other.tolist()))


def cloud(rng, n, size, spread):
    """n spheres in a box of `size` [m]; radii over a factor `spread`, some of them equal."""
    radius = 1e-3 * rng.uniform(1.0, spread, n)
    radius[rng.random(n) < 0.3] = 1e-3
    return rng.uniform(0.0, size, (n, 3)), radius


@pytest.mark.parametrize("reach", [0.0, 5e-4, 4e-3])
@pytest.mark.parametrize(
    ("n", "size", "spread"),
    [(1, 1e-2, 1.0), (120, 1.5e-2, 1.0), (120, 3e-2, 5.0), (60, 0.3, 5.0), (80, (0.2, 2e-3, 1e-2), 3.0)],
)
def test_pairs_are_those_of_brute_force(n, size, spread, reach):
    """Same pairs, same owner, same order: dense and sparse clouds, elongated boxes, five-fold sizes."""
    rng = np.random.default_rng(n)
    position, radius = cloud(rng, n, size, spread)
    position -= 0.01  # cells must not depend on the origin
    normal = rng.normal(size=(4, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    normal[0] = [0.0, 0.0, 1.0]
    point = position.mean(axis=0) - 0.3 * np.asarray(size) * normal
    for planes in (NO_PLANES, NO_PLANES), (point, normal):
        start, other = find_pairs(position, radius, *planes, reach)
        assert start[0] == 0 and start[-1] == other.size and start.size == n + 1
        expected = all_pairs(position, radius, *planes, reach)
        assert listed(start, other) == expected
    if n > 100:
        assert len(expected) > 150


def test_reactions_follow_their_pairs():
    """Spheres move, pairs come and go: old pairs keep their reaction, new ones start from zero."""
    rng = np.random.default_rng(2)
    position, radius = cloud(rng, 150, 2e-2, 4.0)
    point, normal = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    start, other = find_pairs(position, radius, point, normal, 1e-3)
    reaction = rng.normal(size=(other.size, 3))
    kept = dict(zip(listed(start, other), reaction))
    moved = position + rng.normal(0, 5e-4, position.shape)
    new_start, new_other = find_pairs(moved, radius, point, normal, 1e-3)
    carried = carry_reactions(Team(), start, other, reaction, new_start, new_other)
    pairs = listed(new_start, new_other)
    for pair, value in zip(pairs, carried):
        np.testing.assert_array_equal(value, kept.get(pair, np.zeros(3)))
    came, stayed = len(set(pairs) - set(kept)), len(set(pairs) & set(kept))
    assert came > 50 and stayed > 200 and len(kept) > stayed + 50


def test_spheres_that_join_start_without_reactions():
    rng = np.random.default_rng(3)
    position, radius = cloud(rng, 60, 1.2e-2, 3.0)
    planes = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    reach = np.full(60, 1e-3)
    few = find_pairs_within(
        Team(), position[:40], radius[:40], *planes, Reach(reach[:40], 0.0 * reach[:40], reach[:1]), 60
    )
    all_ = find_pairs_within(Team(), position, radius, *planes, Reach(reach, 0.0 * reach, reach[:1]), 60)
    reaction = rng.normal(size=(few[1].size, 3))
    kept = dict(zip(listed(*few), reaction))
    carried = carry_reactions(Team(), *few, reaction, *all_)
    for pair, value in zip(listed(*all_), carried):
        np.testing.assert_array_equal(value, kept.get(pair, np.zeros(3)))
    assert 50 < len(kept) < len(carried)
    nobody = find_pairs_within(
        Team(), position[:0], radius[:0], *planes, Reach(reach[:0], reach[:0], reach[:1]), 60
    )
    assert (nobody[0].tolist(), nobody[1].size) == ([0], 0)


def test_a_team_finds_the_same_pairs_and_carries_the_same_reactions():
    """More members than spheres among them: some find nothing."""
    rng = np.random.default_rng(6)
    for n in (2, 150):
        position, radius = cloud(rng, n, 2e-2, 4.0)
        planes, reach = (np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])), rng.uniform(0.0, 4e-3, n)
        found = []
        for members in (1, 2, 3):
            with Team(members) as team:
                few = find_pairs_within(
                    team, position, radius, *planes, Reach(0.5 * reach, 0.0 * reach, reach[:1]), n
                )
                all_ = find_pairs_within(
                    team, position, radius, *planes, Reach(reach, 0.0 * reach, reach[:1]), n
                )
                reaction = np.arange(3.0 * few[1].size).reshape(-1, 3)
                found.append((*all_, carry_reactions(team, *few, reaction, *all_)))
        for one, two, three in zip(*found):
            np.testing.assert_array_equal(one, two)
            np.testing.assert_array_equal(one, three)


def test_each_sphere_with_a_reach_of_its_own():
    """The reach of the larger sphere of a pair counts; each plane has one, and planes are numbered as told."""
    rng = np.random.default_rng(6)
    position, radius = cloud(rng, 150, 2e-2, 4.0)
    point, normal = np.zeros((2, 3)), np.array([[0.0, 0.0, 1.0]] * 2)
    reach, plane_reach = rng.uniform(0.0, 4e-3, 150), np.array([1e-3, 3e-3])
    extra = np.where(rng.random(150) < 0.2, 1e-3, 0.0)
    found = set(
        listed(
            *find_pairs_within(Team(), position, radius, point, normal, Reach(reach, extra, plane_reach), 150)
        )
    )
    later = set(
        listed(
            *find_pairs_within(Team(), position, radius, point, normal, Reach(reach, extra, plane_reach), 170)
        )
    )
    assert later == {(i, j + 20 if j >= 150 else j) for i, j in found}
    far = all_pairs(position, radius, point, normal, 6e-3)

    def gap(i, j):
        if j >= 150:
            return position[i, 2] - radius[i]
        return np.linalg.norm(position[j] - position[i]) - radius[i] - radius[j]

    def within(i, j):
        return extra[i] + (plane_reach[j - 150] if j >= 150 else reach[i] + extra[j])

    expected = {(i, j) for i, j in far if gap(i, j) < within(i, j)}
    assert found == expected
    assert 100 < len(expected) < 0.8 * len(far)


def test_no_sphere_closes_in_faster_than_the_bound():
    """Grains that rain fast onto slow ones: the bound holds for every pair, and is small far from the slow."""
    rng = np.random.default_rng(7)
    position, radius = cloud(rng, 200, (1e-2, 1e-2, 0.1), 3.0)
    velocity = rng.normal(0.0, 0.01, (200, 3))
    velocity[position[:, 2] > 0.05, 2] -= 5.0
    bound = closing_speeds(Team(), position, radius, velocity, 4e-3)
    with Team(3) as team:
        np.testing.assert_array_equal(closing_speeds(team, position, radius, velocity, 4e-3), bound)
    near: dict[int, list[int]] = {}
    for i, j in all_pairs(position, radius, NO_PLANES, NO_PLANES, 4e-3):
        near.setdefault(i, []).append(j)
    for i, others in near.items():  # any two of them may hit each other by way of i
        fast = velocity[[i, *others]]
        assert np.linalg.norm(fast[:, None] - fast, axis=-1).max() <= bound[i] * (1 + 1e-14)
    assert (bound > 4.9).sum() > 20
    assert (bound < 0.1).sum() > 100


def test_speeds_and_how_far_spheres_moved():
    rng = np.random.default_rng(8)
    velocity, before = rng.normal(size=(50, 6)), rng.normal(size=(40, 3))
    np.testing.assert_array_equal(speeds(velocity), np.sqrt((velocity[:, :3] ** 2).sum(axis=1)))
    position = np.concatenate(
        [before + rng.normal(size=(40, 3)), np.full((10, 3), 99.0)]
    )  # of ten that join later
    allowed = rng.uniform(0.0, 2.0, 40)
    moved = np.sqrt(((position[:40] - before) ** 2).sum(axis=1)) - allowed
    assert moved_beyond(position, before, allowed) == moved.max() > 0.0
    assert moved_beyond(position, before, np.full(40, 9.0)) == 0.0
    assert moved_beyond(position, before[:0], allowed[:0]) == 0.0
