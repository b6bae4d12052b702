"""Threads that run one kernel together and wait for each other within it.

A sweep over a layer takes a fraction of a millisecond and has several points where all must wait. Numba's
own threads take 50 us to start there; members of a team that are awake meet in 1 us.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from asphalt_nscd.nscd.compiled import compiled_for_teams

ARRIVED, MEETINGS, BROKEN_UP, STARTED = 0, 8, 16, 24  # places in a barrier, each in a cache line of its own
SPINS = 2000  # looks at the barrier before a member lets others use its core
AWAKE = 6000  # looks before it falls asleep, after about a millisecond

# a kernel, the barrier, and its other arguments
Task: TypeAlias = tuple[Callable[..., Any], np.ndarray, tuple[Any, ...]]

_give_way = types.ExternalFunction(
    "SwitchToThread" if sys.platform == "win32" else "sched_yield", types.int32()
)


def _pointer(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    return builder.gep(array.data, [arguments[1]])


@intrinsic
def _add(typing_context: Any, array: Any, at: Any, value: Any) -> Any:
    """Add to an element of an int64 array as one action; gives what it was before."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        at = _pointer(context, builder, signature, arguments)
        return builder.atomic_rmw("add", at, arguments[2], "seq_cst")

    return types.int64(array, types.intp, types.int64), code


@intrinsic
def _read(typing_context: Any, array: Any, at: Any) -> Any:
    """An element of an int64 array as other threads left it."""

    def code(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
        return builder.load_atomic(_pointer(context, builder, signature, arguments), "seq_cst", 8)

    return types.int64(array, types.intp), code


@compiled_for_teams
def barrier_wait(barrier, members):
    """Wait until all members are here; then each sees what all others have written."""
    if members == 1:
        return
    meeting = _read(barrier, MEETINGS)
    if _add(barrier, ARRIVED, 1) == members - 1:
        # set back before the others are let go: they may be at the next meeting at once
        _add(barrier, ARRIVED, -members)
        _add(barrier, MEETINGS, 1)
        return
    looks = 0
    # a member that failed will never come
    while _read(barrier, MEETINGS) == meeting and _read(barrier, BROKEN_UP) == 0:
        looks += 1
        if looks > SPINS:
            _give_way()


@compiled_for_teams
def partition(rank, members, count):
    """First and end of what a member takes of `count` things in a row."""
    return rank * count // members, (rank + 1) * count // members


@compiled_for_teams
def mark_started(barrier):
    """Tell, first of all in a kernel, that this member has Python's lock no longer."""
    _add(barrier, STARTED, 1)


@compiled_for_teams
def _reached(count, at, number, most_looks):
    """Wait until a count is at least `number`; False if it is not after `most_looks` looks, 0 being no limit."""
    looks = 0
    while _read(count, at) < number:
        looks += 1
        if looks == most_looks:
            return False
        if looks > SPINS:
            _give_way()
    return True


@compiled_for_teams
def _call(calls, barrier, members):
    """Call other members that are awake, and wait a while until they have begun.

    In one kernel: a member that has to wait for Python's lock falls asleep.
    """
    _add(calls, 0, 1)
    _reached(barrier, STARTED, members - 1, AWAKE)


@compiled_for_teams
def _answer(answers, calls, number):
    """Say that one call is answered, and wait a while for call `number`; False if it did not come."""
    _add(answers, 0, 1)
    return _reached(calls, 0, number, AWAKE)


class _Member(threading.Thread):
    """A thread that stays awake for a while after its work: a step calls it eight times, and waking takes 0.1 ms."""

    def __init__(self, rank: int, members: int, calls: np.ndarray) -> None:
        super().__init__(daemon=True, name=f"member {rank} of a team of {members}")
        self._place, self._calls = (rank, members), calls
        self._answers = np.zeros(1, np.int64)
        self._asleep, self._bell = False, threading.Semaphore(0)
        self.task: Task | None = None  # of a call; None: to end
        self._returned: tuple[Any, BaseException | None] = None, None
        self.start()

    def wake(self) -> None:
        """A call will come."""
        if self._asleep:
            self._bell.release()

    def wait(self, call: int) -> None:
        """Until its kernel has ended at call number `call`."""
        _reached(self._answers, 0, call, 0)

    def result(self, call: int) -> Any:
        """What its kernel returned or raised at call number `call`."""
        self.wait(call)
        value, failure = self._returned
        if failure is not None:
            raise failure
        return value

    def run(self) -> None:
        """Answer one call after another, until one has no task."""
        number, called = 1, _reached(self._calls, 0, 1, AWAKE)
        while True:
            while not called:
                # first asleep, then a look: a call that comes in between finds this member asleep, and rings
                self._asleep = True
                if self._calls[0] < number:
                    self._bell.acquire()
                self._asleep = False
                called = _reached(self._calls, 0, number, AWAKE)
            if self.task is None:
                return
            kernel, barrier, arguments = self.task
            try:
                self._returned = kernel(*self._place, barrier, *arguments), None
            except BaseException as failure:
                barrier[BROKEN_UP] = 1
                self._returned = None, failure
            self.task = None
            del kernel, barrier, arguments  # else the arrays of this call live until the next
            number += 1
            called = _answer(self._answers, self._calls, number)


class Team:
    """So many threads, the caller's among them; close it, or use it as a context."""

    def __init__(self, members: int = 1) -> None:
        self.members = members
        self._calls = np.zeros(1, np.int64)
        self._others = [_Member(rank, members, self._calls) for rank in range(1, members)]

    def run(self, kernel: Callable[..., Any], *arguments: Any) -> list[Any]:
        """Run kernel(rank, members, barrier, *arguments) by all members, and give what each returned.

        The kernel must begin with `mark_started`. If one fails or the caller is interrupted, meetings end.
        """
        barrier = np.zeros(32, np.int64)
        try:
            if self._others:
                self._begin((kernel, barrier, arguments), barrier, self.members)
            call = int(self._calls[0])
            return [
                kernel(0, self.members, barrier, *arguments),
                *(other.result(call) for other in self._others),
            ]
        except BaseException:
            barrier[BROKEN_UP] = 1
            raise

    def _begin(self, task: Task | None, barrier: np.ndarray, members: int) -> None:
        """Give the others a task and call them; None ends them."""
        for other in self._others:
            other.wait(int(self._calls[0]))  # of a call that ended by the failure of another
            other.task = task
            other.wake()
        # compiled, because members that wait for Python's lock fall asleep: 7 us a call, not 88
        _call(self._calls, barrier, members)
        for other in self._others:
            other.wake()  # who fell asleep before the call, and after being looked at

    def __enter__(self) -> Team:
        return self

    def __exit__(self, *_: object) -> None:
        if self._others:
            self._begin(None, np.zeros(32, np.int64), 1)
        for other in self._others:
            other.join()
        self._others = []
        self.members = 1  # who runs a kernel later does all of it
