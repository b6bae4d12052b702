"""Progress bars with the time left, one after another as stages follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bars(unit: str) -> Iterator[Callable[[str, float, float], None]]:
    """Yield report(stage, done, total); a change of stage or a smaller `done` opens a new bar."""
    from tqdm import tqdm

    bar: tqdm | None = None

    def report(stage: str, done: float, total: float) -> None:
        nonlocal bar
        if bar is None or bar.desc != stage:
            if bar is not None:
                bar.close()
            bar = tqdm(
                total=total, desc=stage, unit=unit, mininterval=5.0,
                bar_format="{desc}: {percentage:3.0f}% |{bar:20}| {elapsed} gone, {remaining} left",
            )  # fmt: skip
        bar.update(done - bar.n)

    try:
        yield report
    finally:
        if bar is not None:
            bar.close()
