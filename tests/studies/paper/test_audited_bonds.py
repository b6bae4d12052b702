"""Rows of the audit on the bonds, from the table of readings."""

from __future__ import annotations

import pandas as pd
import pytest
from judgements import by_id, judgement

from studies.paper import outcomes
from studies.paper.bond_readings import AFTER, BARYCENTRES, MEAN_RADIUS, OURS
from studies.paper.finding import DIFFERS, LEFT_OPEN, REPRODUCED, UNCHECKED


def judged(said=1.1, allowed=1.0):
    names = [OURS, AFTER, OURS, BARYCENTRES, MEAN_RADIUS]
    ratios = [said, 1.05, allowed, 80.0, 2.4]
    table = pd.DataFrame(
        {
            "reading": names,
            "friction": [0.2, 0.2, 0.5, 0.2, 0.2],
            "gap_max_mm": [2.0, 1.931, 2.0, 2.0, 2.0],
            "bonds": [70, 60, 65, 70, 70],
            "through_third_sphere_percent": 12.5,
            "E_over_law": ratios,
            "expected": ratios,
            "possible": [False, False, True, False, False],
        }
    )
    return by_id(outcomes.bonds(table))


def test_each_reading_stands_beside_that_of_the_study():
    rows = judged()
    assert rows["reach"].ours == "1.1 or 1.05" and rows["reach"].verdict == LEFT_OPEN
    assert (
        "2 mm (our reading) make 70 bonds" in rows["reach"].evidence
        and "1.931 mm 60" in rows["reach"].evidence
    )
    assert f"allow these readings: {OURS}, friction 0.5: 1.000. A gap" in rows["reach"].evidence
    assert rows["barycentre"].ours == "80 or 1.1" and rows["barycentre"].verdict == LEFT_OPEN


def test_the_smallest_radius_is_conservative_only_where_it_makes_too_soft_a_specimen():
    assert judged(said=1.1)["conservative"].verdict == DIFFERS
    assert judged(said=0.9)["conservative"].verdict == REPRODUCED
    assert judged(said=1.1, allowed=0.99)["conservative"].verdict == LEFT_OPEN


def test_the_poisson_ratio_is_that_of_a_network_and_not_the_printed_one():
    row = judged()["tangential"]
    assert row.verdict == DIFFERS and row.ours == pytest.approx((1 - 1 / 2.7) / (4 + 1 / 2.7))


@pytest.mark.parametrize(("gap", "verdict"), [(3e-5, UNCHECKED), (-1e-9, REPRODUCED)])
def test_contacts_count_only_where_a_gap_closes(gap, verdict):
    row = judgement(outcomes.contacts(pd.DataFrame({"smallest_gap_m": [1e-4, gap]})))
    assert row.verdict == verdict and ("Not exercised" in row.evidence) == (gap > 0)
