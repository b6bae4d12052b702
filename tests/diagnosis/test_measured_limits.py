"""Limits held against what is found: what is put in is what was meant, and the rows say what came of it."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from test_diagnose import table

from asphalt_nscd.diagnosis.record import measured_limits
from asphalt_nscd.diagnosis.record.report import physical_limits
from asphalt_nscd.diagnosis.search.diagnose import diagnose


@pytest.fixture(scope="module")
def empty():
    return diagnose(table(4), draws=500)


def test_both_signs_and_three_sizes_of_each_limit_are_put_in(empty):
    hidden = [one for one in measured_limits.plan(empty) if one.candidate.key == ("channel_delay", None)]
    limit = physical_limits(empty)["channel_delay", None]
    assert sorted(one.times for one in hidden) == [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0]
    for one in hidden:
        assert one.candidate.values[0] == pytest.approx(one.times * limit)
        changed = measured_limits.put_in(empty, one).modulus / empty.observed.modulus
        assert np.angle(changed) == pytest.approx(empty.observed.omega * one.times * limit)
        assert np.abs(changed) == pytest.approx(1.0)
    one_sided = [one.times for one in measured_limits.plan(empty) if one.candidate.key[0] == "guide_friction"]
    assert one_sided == [1.0, 2.0, 3.0]


def test_rows_are_counted_by_cause_and_multiple():
    rows = pd.DataFrame(
        {
            "cause": ["a", "a", "a"],
            "times_limit": [1.0, -1.0, 3.0],
            "named": [1, 0, 1],
            "within_interval": [1, 0, 1],
            "named_instead": ["", "b", ""],
        }
    )
    found = measured_limits.summarised(rows)["a"]
    assert found["1"] == {
        "tried": 2,
        "named": 1,
        "within_interval": 1,
        "other_named": 1,
        "stated_power": pytest.approx(0.95, abs=1e-3),
    }
    assert found["3"]["named"] == 1 and "2" not in found and found["3"]["stated_power"] > 0.999
