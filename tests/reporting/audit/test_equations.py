"""Rows of the audit that need no simulation, and those on other readings."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.reporting.audit import equations
from asphalt_nscd.reporting.audit.statement import DIFFERS, INCONSISTENT, REPRODUCED, compared
from asphalt_nscd.rheology.burgers import Burgers

LAWS = {-10.0: Burgers(39.8e9, 62.8e9, 956e9, 14.9e9), 15.0: Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)}


@pytest.fixture
def rows():
    return {row.where + row.statement[:24]: row for row in equations.equations(LAWS)}


def row_on(rows, text):
    return next(row for key, row in rows.items() if text in key)


def test_number_is_reproduced_only_within_its_tolerance():
    assert compared("", "", 100.0, 101.0, "", 0.01, "").verdict == REPRODUCED
    assert compared("", "", 100.0, 98.9, "", 0.01, "").verdict == DIFFERS
    assert compared("", "", -100.0, 100.0, "", 0.01, "").verdict == DIFFERS


def test_form_factor_against_the_integrated_beam(rows):
    row = row_on(rows, "Form factor")
    assert row.verdict == REPRODUCED
    assert row.ours == pytest.approx(25.09578, rel=1e-6)


def test_strain_is_below_the_stated_limit_and_not_far(rows):
    # at the foot: M = F h, section modulus e B^2 / 6, F = E z / gamma
    foot = 63e-6 / 25095.78 * 0.25 * 6.0 / (0.025 * 0.056**2)
    row = row_on(rows, "An amplitude")
    assert 1e6 * foot < row.ours < 50.0
    assert row.verdict == REPRODUCED


def test_printed_step_compliance_is_negative_and_ours_is_not(rows):
    row = row_on(rows, "Step compliance")
    printed = -1 / (5e-5 * 24.3e9) + 1 / 3.71e9 + 1 / 0.773e9
    assert row.published == pytest.approx(printed) and printed < 0.0
    assert row.ours == pytest.approx(1 / (5e-5 * 24.3e9) + 1 / 3.71e9 + 1 / (0.773e9 + 5e-5 * 48.4e9))
    assert row.verdict == INCONSISTENT


def test_compliance_of_the_law_is_that_of_the_bond(rows):
    assert row_on(rows, "Complex compliance").verdict == REPRODUCED


def test_readings_are_relative_to_the_same_sample():
    pascal, blocked = equations.readings(1.1, {3.0: 1.1, 25.0: 0.55}, {3.0: 2.42, 40.0: 2.53})
    assert pascal.ours == pytest.approx(0.5)
    assert "1.00 at 3 Hz, 0.50 at 25 Hz" in pascal.evidence
    assert blocked.ours == pytest.approx(np.mean([2.2, 2.3]))
    assert blocked.verdict == DIFFERS
