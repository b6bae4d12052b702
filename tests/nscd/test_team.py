"""Threads that meet within a kernel; one that fails keeps none of them waiting."""

from __future__ import annotations

import time

import numpy as np
import pytest

from asphalt_nscd.nscd.compiled import compiled_for_teams
from asphalt_nscd.nscd.team import Team, barrier_wait, mark_started, partition


@compiled_for_teams
def pass_round(rank, members, barrier, rounds, seen):
    """In each round a member reads what its neighbour wrote in the round before; returns how often it was not there."""
    mark_started(barrier)
    missed = 0
    for k in range(rounds):
        missed += seen[k % 2, (rank + 1) % members, 0] != k
        seen[(k + 1) % 2, rank, 0] = k + 1
        barrier_wait(barrier, members)
    return missed


@pytest.mark.parametrize("members", [1, 2, 3])
def test_members_see_what_all_wrote_before_they_met(members):
    with Team(members) as team:
        for _ in range(3):
            assert team.run(pass_round, 5000, np.zeros((2, members, 8), np.int64)) == members * [0]


@pytest.mark.parametrize("failure", [MemoryError, KeyboardInterrupt])
@pytest.mark.parametrize("who", [0, 1, 2])
def test_one_that_fails_keeps_none_waiting(who, failure):
    def kernel(rank, members, barrier):
        mark_started(barrier)
        if rank == who:
            raise failure
        barrier_wait(barrier, members)

    with Team(3) as team:
        with pytest.raises(failure):
            team.run(kernel)
        assert team.run(pass_round, 10, np.zeros((2, 3, 8), np.int64)) == [0, 0, 0]


def test_members_that_fell_asleep_are_woken():
    with Team(3) as team:
        for _ in range(5):
            until = time.monotonic() + 60.0
            while not all(other._asleep for other in team._others):
                assert time.monotonic() < until, "members stay awake for ever"
                time.sleep(0.01)
            assert team.run(pass_round, 2, np.zeros((2, 3, 8), np.int64)) == [0, 0, 0]
        threads = list(team._others)
    assert not any(thread.is_alive() for thread in threads)


@pytest.mark.parametrize("members", [1, 2, 3, 8])
def test_shares_join_up(members):
    parts = [partition(rank, members, 13) for rank in range(members)]
    assert parts[0][0] == 0 and parts[-1][1] == 13
    assert [end for _, end in parts[:-1]] == [begin for begin, _ in parts[1:]]
    sizes = [end - begin for begin, end in parts]
    assert max(sizes) - min(sizes) <= 1
