"""The way from the paper to the extended simulation, as pages show it: ladder.csv in means and by temperature."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import the_only

QUANTITIES = {"E": "|E*|", "phase": "phase"}


def read_ladder(paths: Sequence[Path]) -> pd.DataFrame:
    """The one ladder.csv: rung, temperature_C and errors in percent; NaN where one does not apply."""
    table = read_csv(the_only(paths, "ladder"))
    names = ["temperature_C"]
    for quantity in QUANTITIES:
        names += [f"mre_{quantity}{kind}_percent" for kind in ("", "_law", "_held_out")]
        names.append(f"scatter_{quantity}_percent")
    table.require(["rung", *names])
    return pd.DataFrame({"rung": table.text("rung")} | {name: table.numbers_or_nan(name) for name in names})


def means(ladder: pd.DataFrame) -> pd.DataFrame:
    """Means over temperatures by rung, in the order climbed; what holds for some temperatures only is NaN."""
    return ladder.groupby("rung", sort=False).agg(lambda errors: errors.mean(skipna=False))


def left_by_the_last(ladder: pd.DataFrame) -> dict[str, float]:
    """Errors in percent after the last rung, mean over temperatures, by quantity."""
    last = means(ladder).iloc[-1]
    return {quantity: float(last[f"mre_{quantity}_percent"]) for quantity in QUANTITIES}


def inner_held_out(ladder: pd.DataFrame) -> dict[str, float]:
    """Errors of the last rung at temperatures left out of the fit, mean over those between others; may be empty."""
    last = ladder[ladder["rung"] == ladder["rung"].iloc[-1]]
    at = last["temperature_C"]
    inner = last[(at > at.min()) & (at < at.max())]
    held = {quantity: inner[f"mre_{quantity}_held_out_percent"].mean() for quantity in QUANTITIES}
    return {} if any(pd.isna(value) for value in held.values()) else held
