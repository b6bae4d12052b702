"""The table of spheres to pour."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.errors import InputError

MOST_SPHERES = 10_000_000


def read_counts(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """The spheres to pour.

    Parameters
    ----------
    path : path
        CSV with columns diameter_mm, count.

    Returns
    -------
    ndarray (c,)
        Diameters [m].
    ndarray of int (c,)
        Numbers of spheres.

    Raises
    ------
    InputError
        For no sphere, more than MOST_SPHERES, or a count that is not whole.
    """
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
