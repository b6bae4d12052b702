"""What the fatigue of the samples says, beside what is published, theory, and a run of every cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.fatigue import largest_strain_at
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.reporting.tables import fatigue
from asphalt_nscd.specimen.preparation import read_specimen

CHECKED = 1000e-6  # strain of the run of every cycle


def make(
    course: list[Path], profile: list[Path], every_cycle: list[Path], specimen: list[Path]
) -> pd.DataFrame:
    """what, here, beside; every_cycle: the course of the first sample at CHECKED, cycle by cycle."""
    geometry = read_specimen(specimen[0]).geometry
    assert isinstance(geometry, Geometry)
    logs = np.log10([fatigue.life(path) for path in course])
    jumped = fatigue.life(course[0]) * (CHECKED / fatigue.REFERENCE) ** (1 / fatigue.SLOPE)
    damage = pd.concat(map(pd.read_csv, profile)).groupby("height_share")["damage"].mean()
    rows = [
        ("strain that a bond endures a million times, 1e-6", 1e6 * fatigue.tiring(course).endured, np.nan, "set"),
        ("epsilon6 of the samples, 1e-6", 1e6 * fatigue.EPSILON6, 1e6 * fatigue.EPSILON6, "set on what is published"),
        ("slope of the Wöhler line", fatigue.SLOPE, fatigue.SLOPE, "set on what is published"),
        ("standard deviation of log N between samples", logs.std(ddof=1), fatigue.SCATTER, "published"),
        ("height of most damage over that of the specimen", damage.idxmax(), largest_strain_at(geometry) / geometry.h,
         "largest strain of bending theory"),
        (f"cycles of the first sample at {1e6 * CHECKED:g}e-6", jumped, fatigue.life(every_cycle[0]),
         "every cycle stepped"),
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["what", "here", "beside", "beside_is"])
