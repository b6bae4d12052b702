"""Two versions of a table or JSON file, number by number; the first difference in words."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pandas as pd

VOLATILE = ("provenance",)  # of a run, not of its result


def first_difference(published: Path, redone: Path, tolerance: float) -> str | None:
    """Where two files (both .csv or both .json) first differ by more than a relative tolerance; None if nowhere."""
    if not redone.is_file():
        return f"{published}: was not made again"
    read = _table if published.suffix == ".csv" else _json
    before, after = dict(read(published)), dict(read(redone))
    for place in [*before, *(place for place in after if place not in before)]:
        old, new = before.get(place, "nothing"), after.get(place, "nothing")
        if not _same(old, new, tolerance):
            return f"{published}: {place} is {old}, made again {new}"
    return None


def _same(old: Any, new: Any, tolerance: float) -> bool:
    if isinstance(old, float) and isinstance(new, float):
        both_empty = math.isnan(old) and math.isnan(new)
        # Absolute too: a zero may come out as 1e-17 on another processor.
        return both_empty or math.isclose(old, new, rel_tol=tolerance, abs_tol=1e-12)
    return bool(old == new)


def _table(path: Path) -> Iterator[tuple[str, Any]]:
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    for name in frame:
        if name not in VOLATILE:
            for row, text in enumerate(frame[name]):
                yield f"{name} in line {row + 2}", _value(text)


def _json(path: Path) -> Iterator[tuple[str, Any]]:
    yield from _leaves(json.loads(path.read_text(encoding="utf-8")), "")


def _leaves(content: Any, place: str) -> Iterator[tuple[str, Any]]:
    if isinstance(content, dict | list):
        for key, item in content.items() if isinstance(content, dict) else enumerate(content):
            if key not in VOLATILE:
                yield from _leaves(item, f"{place}.{key}".lstrip("."))
    else:
        # 1 and 1.0 are one number, whichever of the two JSON has.
        yield place, float(content) if isinstance(content, int) else content


def _value(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text
