"""Table 1: the sieve curve of the mix, and the spheres that stand for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.tables.table2 import COUNT, PERCENT, SIEVE


def make(grading: list[Path], used: list[Path]) -> pd.DataFrame:
    """One row for each sieve, coarse first: passing and retained in percent, spheres of that diameter and their share.

    spheres: number poured, none where a sieve belongs to the mastic. retained_shown_percent: share of the sieve in all
    that spheres stand for; volume_percent: share of its spheres in the volume of all.
    """
    sieves = read_csv(only_file(grading, "grading"))
    sieves.require(["diameter_mm", "passing_percent"])
    counts = read_csv(only_file(used, "used"))
    counts.require(["diameter_mm", "count"])
    number = pd.Series(counts.numbers("count", COUNT), index=counts.numbers("diameter_mm", SIEVE))
    table = pd.DataFrame(
        {
            "diameter_mm": sieves.numbers("diameter_mm", SIEVE),
            "passing_percent": sieves.numbers("passing_percent", PERCENT),
        }
    ).sort_values("diameter_mm", ascending=False, ignore_index=True)
    table["retained_percent"] = np.abs(np.diff(table["passing_percent"], prepend=100.0))
    # Int64 with a capital holds whole numbers beside sieves that no sphere stands for.
    table["spheres"] = table["diameter_mm"].map(number).astype("Int64")
    shown = table["spheres"].notna()
    volume = table["spheres"].astype(float) * table["diameter_mm"] ** 3
    table["retained_shown_percent"] = (
        100.0 * table["retained_percent"].where(shown) / table["retained_percent"][shown].sum()
    )
    table["volume_percent"] = 100.0 * volume / volume.sum()
    return table
