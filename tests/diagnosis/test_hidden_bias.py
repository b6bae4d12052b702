"""An error of temperature at one of four isotherms: the shift law follows it, and no shift of a mix looks like that."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from asphalt_nscd.diagnosis.model.chance import ABSORBED
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.search import doubts
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.table_import.campaign import read_campaign

pytestmark = pytest.mark.slow

EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"


def recorded(at: float, too_warm: float) -> Diagnosis:
    """The tutorial's exports, one isotherm of which was recorded too warm, chamber and sensor alike [K]."""
    observed, _ = read_observations(read_campaign([EXPORTS])[0], PAPER_GEOMETRY)
    wrong = too_warm * (observed.isotherm == at)
    return diagnose(
        replace(
            observed,
            temperature=observed.temperature + wrong,
            nominal_temperature=observed.isotherm + wrong,
        ),
        draws=1000,
    )


@pytest.fixture(scope="module")
def right() -> Diagnosis:
    return recorded(35.0, 0.0)


def biases(diagnosis: Diagnosis) -> dict[float, float]:
    """Size [K] of the one that is named and of those that fit as well, by isotherm."""
    return {
        one.place: one.values[0]
        for rung in diagnosis.ladder.rungs
        for one in (rung.candidate, *rung.rivals)
        if one.cause.name == "temperature_bias"
    }


@pytest.mark.parametrize("at,too_warm,named", [(35.0, 3.0, 38.0), (35.0, -3.0, None), (20.0, 3.0, 23.0)])
def test_a_bias_that_the_shift_follows_is_found_with_its_size(at, too_warm, named):
    """Where another isotherm fits as well, either may be named, and neither is established."""
    found = recorded(at, too_warm)
    told = biases(found)
    assert told[at + too_warm] == pytest.approx(-too_warm, abs=0.35)
    (rung,) = [one for one in found.ladder.rungs if one.candidate.key[0] == "temperature_bias"]
    assert named is None or rung.candidate.place == named
    assert not found.established(rung) or len(told) == 1


def test_exports_without_a_bias_get_none(right):
    assert biases(right) == {}


def test_every_isotherm_of_four_has_a_limit_and_a_bias_beyond_it_is_found(right):
    limits = {
        place: size for (name, place), size in right.ladder.limits.items() if name == "temperature_bias"
    }
    assert set(limits) >= {4.0, 20.0, 35.0}
    for place in {4.0, 50.0} & set(
        limits
    ):  # which of the four is off is not always told, that one is must be
        assert biases(recorded(place, -1.5 * limits[place])), place


def test_a_direction_is_followed_if_the_fit_leaves_a_trifle_of_it(right):
    fitted = right.ladder.fitted
    within = fitted.jacobian @ np.ones(fitted.jacobian.shape[1])
    residual = np.linalg.qr(fitted.jacobian, mode="complete")[0][:, -1]  # at right angles to all it can do
    free = replace(
        fitted, precision=fitted.jacobian.T @ fitted.jacobian + 1e-9 * np.eye(fitted.gradient.size)
    )
    assert doubts._followed(free, within[:, None])
    assert not doubts._followed(free, residual[:, None])
    mostly = within / np.linalg.norm(within) + 2.0 * np.sqrt(ABSORBED) * residual
    assert not doubts._followed(free, mostly[:, None])
