"""Progress bars with the time left, one after another as stages follow."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tqdm import tqdm

SHORT = 1.0  # s; a stage that takes less shows nothing, and most tests are one: they need not load what draws bars


@contextmanager
def bars(unit: str, on_terminal: bool = False) -> Iterator[Callable[[str, float, float], None]]:
    """Yield report(stage, done, total); a change of stage opens a new bar.

    `on_terminal` shows bars on a terminal alone, and often; else they go into a log too, a line in five seconds.
    """
    bar: tqdm | None = None
    shown, began = "", time.time()

    def report(stage: str, done: float, total: float) -> None:
        nonlocal bar, shown, began
        if shown != stage:
            if bar is not None:
                bar.close()
            bar, shown, began = None, stage, time.time()
        if bar is None:
            if time.time() - began < SHORT:
                return
            from tqdm import tqdm

            bar = tqdm(
                total=total,
                desc=stage,
                unit=unit,
                # In a log each refresh is a line: one in five seconds.
                mininterval=0.1 if on_terminal else 5.0,
                # None: tqdm is silent by itself where there is no terminal.
                disable=None if on_terminal else False,
                bar_format="{desc}: {percentage:3.0f}% |{bar:20}| {elapsed} elapsed, {remaining} left",
            )
            # The stage began before its bar, which opens after SHORT.
            bar.start_t = began
        bar.update(done - bar.n)

    try:
        yield report
    finally:
        if bar is not None:
            bar.close()
