"""Rows of the audit that need no particle."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from judgements import by_id

from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.rheology.burgers import Burgers
from studies.paper import equations
from studies.paper.audit import judged
from studies.paper.finding import DIFFERS, HOLDS, INCONSISTENT, LEFT_OPEN, REPRODUCED, Finding

LAWS = {-10.0: Burgers(39.8e9, 62.8e9, 956e9, 14.9e9), 15.0: Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)}
COUNTS = np.array([2, 4, 6.3, 8, 10]) * 1e-3, np.array([11798, 1588, 492, 211, 71])


def test_number_agrees_only_within_its_tolerance():
    def verdict(published, ours, needs="particles"):
        row = {"id": "", "needs": needs, "published": published, "tolerance": 0.01}
        return judged(row, Finding("", ours))["verdict"]

    assert verdict(100.0, 101.0) == REPRODUCED and verdict(100.0, 101.0, "text") == HOLDS
    assert verdict(100.0, 98.9) == verdict(-100.0, 100.0) == DIFFERS


def test_form_factor_and_strain_of_the_cantilever():
    rows = by_id(equations.laboratory())
    assert rows["form_factor"].verdict == HOLDS
    assert rows["form_factor"].ours == pytest.approx(25.09578, rel=1e-6)
    # at the foot: M = F h, section modulus e B^2 / 6, F = E z / gamma
    foot = 63e-6 / 25095.78 * 0.25 * 6.0 / (0.025 * 0.056**2)
    assert 1e6 * foot < rows["strain"].ours < 50.0 and rows["strain"].verdict == HOLDS


def test_mass_factor_is_that_of_a_beam_and_of_a_prism_the_known_one(monkeypatch):
    trapezoid = by_id(equations.laboratory())["mass_factor"]
    assert trapezoid.verdict == DIFFERS and 0.14 < trapezoid.ours < 0.15
    prism = Geometry(b=0.056, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
    monkeypatch.setattr(equations, "PAPER", prism)
    assert by_id(equations.laboratory())["mass_factor"].ours == pytest.approx(33 / 140, rel=1e-6)


def test_printed_step_compliance_is_negative_and_ours_is_not():
    row = by_id(equations.contact_law(LAWS[15.0]))["step_law"]
    printed = -1 / (5e-5 * 24.3e9) + 1 / 3.71e9 + 1 / 0.773e9
    assert f"{printed:.3g} at" in row.evidence and printed < 0.0
    assert row.ours == pytest.approx(1 / (5e-5 * 24.3e9) + 1 / 3.71e9 + 1 / (0.773e9 + 5e-5 * 48.4e9))
    assert row.verdict == INCONSISTENT


def test_compliance_of_the_law_is_that_of_the_bond_and_its_limit_Em():
    design = pd.DataFrame(
        {"mix": ["BBSG 2 and 3", "BBME 1"], "temperature_C": 15.0, "E_MPa": [7000.0, 9000.0]}
    )
    rows = by_id(equations.calibration(LAWS, {3.0: 1.0, 25.0: 0.4}, 2e-7, design))
    assert rows["compliance"].verdict == HOLDS
    assert rows["limit_Em"].ours == pytest.approx(1.0, abs=1e-6)
    assert "1.00 at 3 Hz, 0.40 at 25 Hz" in rows["table3_unit"].evidence
    scale = np.sqrt(2.86e-5 / (np.pi * 1e-6 / 2e-3 * 2.43e10))
    assert f"in kPa it is {scale:.2g} s" in rows["table3_unit"].evidence
    assert "dt is 250 times" in rows["table3_unit"].evidence
    stiff = abs(LAWS[15.0].complex_modulus(20 * np.pi)) / 7e9
    assert rows["level_of_table3"].ours == f"{stiff:.1f}" and rows["level_of_table3"].verdict == LEFT_OPEN


@pytest.mark.parametrize(("cold", "verdict"), [(20.0, HOLDS), (200.0, DIFFERS)])
def test_errors_of_small_phases_are_compared_in_degrees(cold, verdict):
    printed = pd.DataFrame({"temperature_C": [-10.0, 15.0], "mre_phase_percent": [cold, 5.0]})
    row = by_id(equations.table_4(LAWS, printed))["small_numbers"]
    phases = np.degrees(np.angle(LAWS[-10.0].complex_modulus(equations.OMEGA)))
    assert row.ours == pytest.approx(cold / 100 * phases.mean()) and row.verdict == verdict


def test_typical_numbers():
    rows = by_id(equations.typical_numbers(*COUNTS, 3415.0))
    assert rows["mean_size"].verdict == rows["rearrangement"].verdict == HOLDS
    # the mean mass from the definition, sphere by sphere
    mass = 3415.0 * np.pi / 6.0 * np.repeat(COUNTS[0], COUNTS[1]) ** 3
    assert rows["mean_mass"].ours == pytest.approx(mass.mean())
