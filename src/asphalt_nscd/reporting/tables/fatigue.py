"""Fatigue of the samples: cycles to half of the stiffness at three strains, with the bonds set on one mix."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.bending.fatigue import FAILURE
from asphalt_nscd.bending.further_settings import MILLION, FatigueLaw

STRAINS = (90e-6, 120e-6, 150e-6)
EPSILON6, SLOPE, SCATTER = 100e-6, -1 / 5, 0.25
"""Of a BBSG at 10 degC and 25 Hz, and the standard deviation of log N: NF P98-086 (2019), at second hand (docs)."""
REFERENCE = 100e-6  # strain of the courses, and what their bonds endured


def life(course: Path) -> float:
    """Cycles to FAILURE, interpolated between the jumps."""
    table = pd.read_csv(course)
    # Both signs turned, for np.interp wants places that rise, and the stiffness falls.
    return float(np.interp(-FAILURE, -table["stiffness"], table["cycles"]))


def factor(courses: list[Path]) -> float:
    """Factor on the cycles of the courses by which the samples, in the mean of log N, bear a million at EPSILON6."""
    lives = np.array([life(path) for path in courses])
    return float(MILLION / np.exp(np.log(lives).mean()) * (REFERENCE / EPSILON6) ** (1 / SLOPE))


def fatigue_law(courses: list[Path]) -> FatigueLaw:
    """The law of bonds that multiplies the cycles by `factor`."""
    return FatigueLaw(endured=REFERENCE * factor(courses) ** -SLOPE, exponent=-1 / SLOPE)


def make(course: list[Path]) -> pd.DataFrame:
    """A row for each sample and strain: life with bonds of `fatigue_law`; course: a file a sample, at REFERENCE.

    Openings are proportional to the motion of the head, so that a strain multiplies the cycles of every bond, and of
    the sample, by the same power of it. A second strain needs no second run.
    """
    grows = factor(course)
    rows = [
        (path.stem, 1e6 * strain, life(path) * grows * (strain / REFERENCE) ** (1 / SLOPE))
        for strain in STRAINS
        for path in course
    ]
    return pd.DataFrame(rows, columns=["sample", "strain_1e-6", "cycles"])
