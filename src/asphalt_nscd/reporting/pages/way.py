"""The way from the paper to the extended simulation, as pages show it: ladder.csv in means and by temperature."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import only_file

LIKELIEST = "likeliest"  # the rung of the likeliest reading of the paper, below all others
QUANTITIES = {"E": "|E*|", "phase": "phase"}


def read_ladder(paths: Sequence[Path]) -> pd.DataFrame:
    """Read the one ladder.csv: rung, temperature_C and errors in percent; NaN where one does not apply."""
    table = read_csv(only_file(paths, "ladder"))
    names = ["temperature_C"]
    for quantity in QUANTITIES:
        names += [f"mre_{quantity}{kind}_percent" for kind in ("", "_law", "_held_out")]
        names.append(f"scatter_{quantity}_percent")
    table.require(["rung", *names])
    names += [name for q in QUANTITIES if (name := f"mre_{q}_published_percent") in table.columns]
    return pd.DataFrame({"rung": table.text("rung")} | {name: table.numbers_or_nan(name) for name in names})


def means(ladder: pd.DataFrame) -> pd.DataFrame:
    """Mean errors [%] over temperatures by rung, in the order climbed; NaN where some temperature has none."""
    return ladder.groupby("rung", sort=False).agg(lambda errors: errors.mean(skipna=False))


def left_by_the_last(ladder: pd.DataFrame) -> dict[str, float]:
    """Errors [%] after the last rung, mean over temperatures, by "E" and "phase"."""
    last = means(ladder).iloc[-1]
    return {quantity: float(last[f"mre_{quantity}_percent"]) for quantity in QUANTITIES}


def held_out(ladder: pd.DataFrame, ends: bool) -> dict[str, float]:
    """Errors [%] of the last rung at temperatures left out of the fit, by "E" and "phase".

    With `ends` they are means over the coldest and the warmest, else over all between; empty where too few temperatures
    were tested.
    """
    last = ladder[ladder["rung"] == ladder["rung"].iloc[-1]]
    at = last["temperature_C"]
    chosen = last[at.isin([at.min(), at.max()]) == ends]
    held = {quantity: chosen[f"mre_{quantity}_held_out_percent"].mean() for quantity in QUANTITIES}
    return {} if any(pd.isna(value) for value in held.values()) else held
