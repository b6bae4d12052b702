"""Progress bars with the time left, one after another as stages follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bars(unit: str, on_terminal: bool = False) -> Iterator[Callable[[str, float, float], None]]:
    """Yield report(stage, done, total); a change of stage or a smaller `done` opens a new bar.

    on_terminal: nothing is shown elsewhere, and more often there.
    """
    from tqdm import tqdm

    bar: tqdm | None = None
    shown = ""

    def report(stage: str, done: float, total: float) -> None:
        nonlocal bar, shown
        if bar is None or shown != stage:
            if bar is not None:
                bar.close()
            shown = stage
            bar = tqdm(
                total=total,
                desc=stage,
                unit=unit,
                mininterval=0.1 if on_terminal else 5.0,
                disable=None if on_terminal else False,
                bar_format="{desc}: {percentage:3.0f}% |{bar:20}| {elapsed} gone, {remaining} left",
            )
        bar.update(done - bar.n)

    try:
        yield report
    finally:
        if bar is not None:
            bar.close()
