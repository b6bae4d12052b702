"""A row is judged by its tolerance, and a red one cannot be overlooked."""

from __future__ import annotations

import math

import pandas as pd

from theory.rows import FAILED, PASSED, judged, order, summarised


def test_rows_are_judged():
    assert judged("a", 2.0, 2.002, 1.1e-3, "")["verdict"] == PASSED
    assert judged("a", 2.0, 2.002, 0.9e-3, "")["verdict"] == FAILED
    assert judged("a", 0.0, 1e-3, 1e-2, "")["error"] == 1e-3
    assert judged("a", 1.0, math.nan, 1.0, "")["verdict"] == FAILED
    assert judged("a", -2.0, 2.0, 1.0, "")["verdict"] == FAILED
    assert order([8.0, 4.0, 1.0]) == 2.0


def test_summary():
    errors, tolerances = [0.05, 2.0, 0.0], [0.1, 0.5, 0.0]
    rows = pd.DataFrame({"theme": ["a", "a", "b"], "error": errors, "tolerance": tolerances})
    found = summarised(rows.assign(verdict=[PASSED, FAILED, PASSED]))
    assert found["rows"].tolist() == [2, 1] and found["passed"].tolist() == [1, 1]
    assert found["largest_error_over_tolerance"].tolist()[0] == 4.0
