"""What the fatigue of the samples says, beside what is published, theory, and a run of every cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.fatigue import largest_strain_at
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.reporting.tables import fatigue
from asphalt_nscd.specimen.cutting import read_specimen


def make(course: list[Path], profile: list[Path], check: list[Path], specimen: list[Path]) -> pd.DataFrame:
    """A row for each number, and what stands beside; check: a small sample by jumps, by finer ones, by every cycle."""
    geometry = read_specimen(specimen[0]).geometry
    assert isinstance(geometry, Geometry)
    logs = np.log10([fatigue.life(path) for path in course])
    jumped, fine, stepped = map(fatigue.life, check)
    heights = [table.loc[table["damage"].idxmax(), "height_share"] for table in map(pd.read_csv, profile)]
    theory = largest_strain_at(geometry) / geometry.h
    rows = [
        ("strain that a bond endures a million times, 1e-6", 1e6 * fatigue.fatigue_law(course).endured, np.nan, "set"),
        ("epsilon6 of the samples, 1e-6", 1e6 * fatigue.EPSILON6, 1e6 * fatigue.EPSILON6, "set on what is published"),
        ("slope of the Wöhler line", fatigue.SLOPE, fatigue.SLOPE, "set on what is published"),
        ("standard deviation of log N between samples", logs.std(ddof=1), fatigue.SCATTER, "published"),
        ("height of most damage over h, lowest sample", min(heights), theory, "largest strain of bending theory"),
        ("height of most damage over h, highest sample", max(heights), theory, "largest strain of bending theory"),
        ("cycles of a small sample at a large strain", jumped, stepped, "every cycle stepped"),
        ("the same by jumps ten times as fine", fine, stepped, "every cycle stepped"),
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["what", "here", "beside", "beside_is"])
