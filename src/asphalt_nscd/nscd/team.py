"""Threads that run one kernel together and wait for each other within it.

A sweep over a layer takes a fraction of a millisecond and has several points where all must wait. Numba's
own threads take 50 us to start there; members of a team that are awake meet in 1 us.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from asphalt_nscd.nscd.compiled import compiled_for_teams

ARRIVED, MEETINGS, BROKEN_UP = 0, 8, 16  # places in a barrier, each in a cache line of its own
SPINS = 2000  # looks at the barrier before a member lets others use its core

_give_way = types.ExternalFunction(
    "SwitchToThread" if sys.platform == "win32" else "sched_yield", types.int32()
)


def _pointer(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> ir.Value:
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    return builder.gep(array.data, [arguments[1]])


@intrinsic
def _add(typing_context: Any, array: Any, at: Any, value: Any) -> Any:
    """Add to an element of an int64 array as one action; what it was before."""

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
def meet(barrier, members):
    """Wait until all members are here; then each sees what all others have written."""
    if members == 1:
        return
    meeting = _read(barrier, MEETINGS)
    if _add(barrier, ARRIVED, 1) == members - 1:
        _add(barrier, ARRIVED, -members)
        _add(barrier, MEETINGS, 1)
        return
    looks = 0
    while _read(barrier, MEETINGS) == meeting and _read(barrier, BROKEN_UP) == 0:
        looks += 1
        if looks > SPINS:
            _give_way()


@compiled_for_teams
def share(rank, members, count):
    """First and end of what member `rank` takes of so many things in a row."""
    return rank * count // members, (rank + 1) * count // members


class Team:
    """So many threads, the caller's among them. Close it, or use it as a context."""

    def __init__(self, members: int = 1) -> None:
        self.members = members
        self._others = ThreadPoolExecutor(members - 1) if members > 1 else None

    def run(self, kernel: Callable[..., Any], *arguments: Any) -> list[Any]:
        """kernel(rank, members, barrier, *arguments) by all members; what each returned.

        The kernel is compiled for teams. If one member fails or the caller is interrupted, meetings end.
        """
        barrier = np.zeros(24, np.int64)

        def work(rank: int) -> Any:
            try:
                return kernel(rank, self.members, barrier, *arguments)
            except BaseException:
                barrier[BROKEN_UP] = 1
                raise

        others: list[Future[Any]] = []
        try:
            if self._others is not None:
                for rank in range(1, self.members):
                    others.append(self._others.submit(work, rank))
            return [work(0), *(future.result() for future in others)]
        except BaseException:
            barrier[BROKEN_UP] = 1
            raise

    def __enter__(self) -> Team:
        return self

    def __exit__(self, *_: object) -> None:
        if self._others is not None:
            self._others.shutdown()
