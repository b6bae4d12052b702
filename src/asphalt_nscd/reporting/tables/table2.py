"""Table 2: spheres of each size, as published, as the sieve curve of Table 1 asks for, and as used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.tables import only_file

PERCENT = Limits(0.0, 100.0, "give a percentage")
SIEVE = Limits(1e-4, 1000.0, "give the sieve in mm")
COUNT = Limits(0.0, 1e9, "give the number of spheres")


def make(grading: list[Path], published: list[Path], used: list[Path]) -> pd.DataFrame:
    """One row for each diameter that is published or used.

    Counts from the grading are scaled to as many spheres as are published; they stand only beside
    diameters that are sieves of the grading.
    """
    sieves = read_csv(only_file(grading, "grading"))
    sieves.require(["diameter_mm", "passing_percent"])
    curve = sieves.numbers("diameter_mm", SIEVE), sieves.numbers("passing_percent", PERCENT)
    printed, poured = _counts(published, "published"), _counts(used, "used")
    smallest = min(printed.index)
    graded = counts_of_grading(*curve, smallest, int(printed.sum()))
    table = pd.DataFrame({"count_published": printed, "count_from_grading": graded, "count_used": poured})
    table = table.sort_index().rename_axis("diameter_mm").reset_index()
    volume = table["diameter_mm"] ** 3
    for name in ("published", "from_grading", "used"):
        share = table[f"count_{name}"] * volume
        table[f"volume_{name}_percent"] = 100.0 * share / share.sum()
    return table.astype({f"count_{name}": "Int64" for name in ("published", "from_grading", "used")})


def counts_of_grading(
    sieve: NDArray[np.float64], passing: NDArray[np.float64], smallest: float, total: int
) -> pd.Series:
    """Numbers of spheres by diameter [mm] whose masses follow a sieve curve cut at `smallest`.

    What a sieve retains becomes spheres of that sieve's diameter, all of one density; the numbers
    are rounded so that they add up to `total` (largest remainders).
    """
    order = np.argsort(sieve)
    sieve, passing = sieve[order], passing[order]
    if (np.diff(passing) < 0).any():
        raise InputError("the sieve curve falls with the diameter; a larger sieve must let more pass.")
    retained = np.diff(passing, append=100.0)
    kept = (sieve >= smallest * (1.0 - 1e-9)) & (retained > 0.0)
    if not kept.any():
        raise InputError(f"the sieve curve retains nothing from {smallest:g} mm up; give a coarser one.")
    exact = retained[kept] / sieve[kept] ** 3
    exact *= total / exact.sum()
    counts = np.floor(exact).astype(int)
    # The largest remainders get what rounding down has left, so that the numbers add up to the total.
    counts[np.argsort(counts - exact, kind="stable")[: total - counts.sum()]] += 1
    return pd.Series(counts, index=sieve[kept])


def _counts(paths: list[Path], kind: str) -> pd.Series:
    table = read_csv(only_file(paths, kind))
    table.require(["diameter_mm", "count"])
    return pd.Series(table.numbers("count", COUNT), index=table.numbers("diameter_mm", SIEVE))
