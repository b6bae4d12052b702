"""Which rules make what of the paper, into which files, and how long they take."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import the_only


def make(outputs: list[Path], timings: list[Path]) -> pd.DataFrame:
    """One row for each part of the paper; minutes are those of all jobs of its rules, one after another."""
    parts, timed = read_csv(the_only(outputs, "outputs")), read_csv(the_only(timings, "timings"))
    parts.require(["in_the_paper", "rules", "files"])
    timed.require(["rule", "wall_s"])
    seconds = dict(zip(timed.text("rule"), timed.numbers("wall_s"), strict=True))
    rules = [cell.split() for cell in parts.text("rules")]
    return pd.DataFrame(
        {
            "in the paper": parts.text("in_the_paper"),
            "rules": [_names(names) for names in rules],
            "files": [_names(cell.split()) for cell in parts.text("files")],
            "minutes": [round(sum(seconds.get(name, 0.0) for name in names) / 60.0, 2) for names in rules],
        }
    )


def _names(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
