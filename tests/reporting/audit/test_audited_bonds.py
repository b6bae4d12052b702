"""Rows of the audit on the bonds, from the table of readings."""

from __future__ import annotations

import pandas as pd

from asphalt_nscd.reporting.audit import preparation
from asphalt_nscd.reporting.audit.statement import DIFFERS, INCONSISTENT


def test_each_reading_stands_beside_that_of_the_study():
    table = pd.DataFrame(
        {
            "reading": ["as in the paper", "smaller", "without moments"],
            "gap_max_mm": [2.0, 1.931, 2.0],
            "bonds": [70, 60, 70],
            "through_third_sphere_percent": [12.5, 10.0, 12.5],
            "E_over_law": [1.1, 1.0, 80.0],
        }
    )
    distance, moments, third = preparation.bonds(table)
    assert (distance.published, distance.ours, distance.verdict) == (1.1, 1.0, DIFFERS)
    assert "2 mm, 70 bonds" in distance.evidence and "1.931 mm, 60 bonds" in distance.evidence
    assert (moments.published, moments.ours, moments.verdict) == (1.0, 80.0, INCONSISTENT)
    assert (third.published, third.ours, third.verdict) == (0.0, 12.5, DIFFERS)
