"""The table of spheres to pour."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.errors import InputError

MOST_SPHERES = 10_000_000


def read_counts(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Diameters [m] and numbers (c,) of the spheres to pour, from a CSV with columns diameter_mm, count."""
    table = read_csv(path)
    table.require(["diameter_mm", "count"])
    diameters = table.numbers("diameter_mm", Limits(0.01, 100.0, "give the diameter in mm"))
    counts = table.numbers("count", Limits(0, MOST_SPHERES, "give the number of spheres"))
    for row, count in enumerate(counts):
        if count != round(count):
            raise table.error(row, f"count = {count:g} is not a whole number; give the number of spheres.")
    if counts.sum() > MOST_SPHERES:
        raise InputError(f"{path}: counts {counts.sum():g} spheres; give at most {MOST_SPHERES:g}.")
    if not counts.any():
        raise InputError(f"{path}: counts no sphere; give at least one.")
    return diameters * 1e-3, counts.astype(int)
