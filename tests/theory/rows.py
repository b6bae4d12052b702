"""Rows of the verification table and how they are judged."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

# In the order of the published table.
THEMES = "spheres edges contacts coupled law beams facets films skeleton methods accounts fracture determinism".split()
COLUMNS = ["name", "expected", "found", "error", "tolerance", "verdict", "source"]
PASSED, FAILED = "passed", "failed"


def judged(
    name: str, expected: float, found: float, tolerance: float, source: str, scale: float = math.nan
) -> dict[str, str | float]:
    """One row of COLUMNS: what theory expects by `source`, what was found, and whether they agree.

    `tolerance` is of |found - expected| over `scale`, which is |expected|, or one where nothing is expected.
    """
    size = scale if math.isfinite(scale) else abs(expected) or 1.0
    error = float(abs(found - expected) / size)
    verdict = PASSED if error <= tolerance else FAILED  # what is not a number has failed
    values = (name, float(expected), float(found), error, tolerance, verdict, source)
    return dict(zip(COLUMNS, values))


def summarised(rows: pd.DataFrame) -> pd.DataFrame:
    """For each theme: rows, how many passed, and the largest error over its tolerance where that is not zero."""
    share = (rows["error"] / rows["tolerance"]).where(rows["tolerance"] > 0.0)
    themes = rows.assign(share=share, passed=rows["verdict"] == PASSED).groupby("theme", sort=False)
    return themes.agg(
        rows=("passed", "size"), passed=("passed", "sum"), largest_error_over_tolerance=("share", "max")
    ).reset_index()


def order(errors: ArrayLike) -> float:
    """Order of convergence from the last two errors, of steps halved each time."""
    coarse, fine = np.asarray(errors, float)[-2:]
    return math.log2(abs(coarse / fine))
