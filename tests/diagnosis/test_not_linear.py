"""A mix that is not linear where it is soft is no fault of the machine; an offset of all phases is one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_one_search import TRAPEZOIDS
from test_one_search import table as broken_table

from asphalt_nscd.api.tables import campaign_in
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record.mixture import mixture
from asphalt_nscd.diagnosis.record.reported import corrected
from asphalt_nscd.diagnosis.record.statuses import kept, odd_places, statuses
from asphalt_nscd.diagnosis.screening.excess_phase import shows_excess
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose

pytestmark = pytest.mark.slow

NCAT = Path(__file__).parents[2] / "data/ncat"


def table(lost: float, gained: float, offset: float = 0.0) -> Observations:
    """|E*| lost and phase [deg] gained in proportion to the temperature above 0 degC; offset [deg] in all tests."""
    linear = broken_table(broken=0.0, design=TRAPEZOIDS)
    soft = np.maximum(linear.temperature, 0.0) / 30.0
    effect = soft * (np.log1p(-lost) + 1j * np.radians(gained)) + 1j * np.radians(offset)
    return replace(linear, modulus=linear.modulus * np.exp(effect), test_type="tension-compression")


def names(diagnosis: Diagnosis) -> dict[str, bool]:
    """Whether each is established."""
    return {rung.candidate.cause.name: diagnosis.established(rung) for rung in diagnosis.ladder.rungs}


def turned(diagnosis: Diagnosis) -> float:
    """Most by which corrected.csv turns a phase [deg]."""
    whole = diagnosis.whole
    record = statuses(diagnosis, whole, odd_places(diagnosis, whole))
    rows = corrected(diagnosis, whole, mixture(diagnosis, kept(record)), record)
    return float((rows.phase_deg - rows.recorded_phase_deg).abs().max())


def test_a_mix_that_is_not_linear_is_no_fault_of_the_machine(monkeypatch):
    found = diagnose(table(0.1, 4.0), draws=1000)
    assert "film_softening" in names(found)
    assert not any(sure for name, sure in names(found).items() if name != "film_softening")
    assert turned(found) < 1e-9
    monkeypatch.setattr(
        Diagnosis, "established", lambda _, rung: rung.candidate.cause.name == "film_softening"
    )
    assert turned(found) < 1e-9  # however sure: what the mix does stays in the tests


def test_an_offset_of_all_phases_is_still_found_and_taken_off():
    found = diagnose(table(0.0, 0.0, 2.0), draws=1000)
    assert names(found) == {"phase_offset": True}
    assert turned(found) == pytest.approx(2.0, abs=0.2)


def test_an_offset_no_larger_than_mixes_make_is_told_and_left_in_the_tests():
    found = diagnose(table(0.0, 0.0, -0.7), draws=1000)
    assert names(found) == {"phase_offset": False}
    assert turned(found) < 1e-9


@pytest.mark.parametrize("lost,gained,shown", [(0.0, 0.0, False), (0.0, 3.0, True), (0.0, -3.0, False)])
def test_only_phases_above_what_modulus_requires_speak_for_it(lost, gained, shown):
    observed = table(lost, gained)
    assert shows_excess(observed, scatter.stated(observed, 0.01, np.radians(0.3), 0.03)) == shown


def test_no_measured_table_is_told_to_subtract_an_offset(state="S6-1_RH"):
    observed, _ = read_observations(
        campaign_in(NCAT / f"{state}.csv", measured_in="tension-compression"), PAPER_GEOMETRY
    )
    found = diagnose(observed, draws=1000)
    assert turned(found) < 1e-9 and not any(names(found).values())
