"""What diagnoses, comparisons and forecasts show, of contents that are made up: by value, and quick."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from pandas.testing import assert_frame_equal

import asphalt_nscd as an
from asphalt_nscd.api import comparison, forecasting
from asphalt_nscd.api.comparison import Comparison, _part_of, _ranks
from asphalt_nscd.api.diagnosis import Diagnosis
from asphalt_nscd.diagnosis.run import Outcome
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import forecast
from asphalt_nscd.forecasting.recipe import recipe_of


def errors(before, after):
    return {"before": before, "after": after}


RUNG = {
    "cause": "channel_delay", "where": 20.0, "established": True, "p_value": 1e-4, "sentence": "It is late.",
    "parameters": {"delay_s": {"value": 8e-4, "unit": "s", "std_error": 2e-5}, "other": {"value": 1.0}},
    "gain": {"in_sample": {"averages_by_temperature": {
        "10": {"mre_E_percent": errors(6.0, 2.0), "mre_phase_percent": errors(9.0, 4.0), "off_phase_deg": errors(1, 1)},
        "20": {"mre_E_percent": errors(2.0, 1.0), "mre_phase_percent": errors(3.0, 2.0), "off_phase_deg": errors(1, 1)},
    }}},
    "as_good": ["temperature_bias", "guide_friction"], "hangs_on": [10.0, "A"], "doubts": ["One", "Two"],
    "confirmed_by": "phase",
}  # fmt: skip
UNSURE = {"value": 2, "unit": "1", "std_error": None}
CONTENT = {
    "ladder": [RUNG, RUNG | {"where": None, "established": False, "parameters": {"x": UNSURE}}],
    "suspect_tests": [{
        "specimen": "A", "temperature_C": 20.0, "frequency_Hz": 10.0, "status": "check", "reasons": ["a", "b"],
        "decided_by": "phase", "more": 1,
    }],
    "detection_limits": {
        "channel_delay": {"value": 3e-4, "unit": "s"},
        "temperature_bias": {"value": 9.0, "unit": "K", "confined_to": "isotherm", "places": {"10": 0.5, "20": 0.7}},
    },
    "reading": {"notes": ["read so"]}, "notes": ["found so"], "verdict": "explained", "tests": 71,
    "trust": {"not_used": 2},
}  # fmt: skip


def test_what_a_diagnosis_shows():
    none = pd.DataFrame()
    found = Diagnosis(Outcome(CONTENT, none, none, None))
    one, two = found.ladder.to_dict("records")
    expected = {
        "cause": "channel_delay", "where": 20.0, "parameter": "delay_s", "value": 8e-4, "std_error": 2e-5, "unit": "s",
        "p_value": 1e-4, "error_E_before_percent": 4.0, "error_E_after_percent": 1.5, "error_phase_before_percent": 6.0,
        "error_phase_after_percent": 3.0, "established": True, "as_good": "temperature_bias, guide_friction",
        "hangs_on": "10.0, A", "doubts": "One. Two", "sentence": "It is late.", "confirmed_by": "phase",
    }  # fmt: skip
    assert one == expected and list(found.ladder) == list(expected)
    assert (two["where"], two["parameter"], two["established"]) == ("", "x", False) and np.isnan(
        two["std_error"]
    )
    assert found.suspects.to_dict("records") == [
        {
            "specimen": "A", "temperature_C": 20.0, "frequency_Hz": 10.0, "status": "check", "reasons": "a; b",
            "decided_by": "phase",
        }
    ]  # fmt: skip
    assert found.limits.to_numpy().tolist() == [
        ["channel_delay", "", "", 3e-4, "s"],
        ["temperature_bias", "isotherm", "10", 0.5, "K"],
        ["temperature_bias", "isotherm", "20", 0.7, "K"],
    ]
    assert found.notes == ("read so", "found so") and found.law is None
    named = "channel_delay (20.0) 0.0008 s (established); channel_delay 2 1 (likely)"
    assert repr(found) == f"Diagnosis(explained: {named}; 71 tests used, 2 not used)"
    with pytest.raises(an.InputError, match="read from files; diagnose the measurements again"):
        Diagnosis(
            Outcome(CONTENT | {"provenance": {"scatter_stated": None}}, none, none, None)
        ).verify_limits()


@pytest.mark.parametrize(("apart", "ranks"), [(0.25, ([1, 1, 3], [2, 2, 3])), (0.30, ([1, 2, 3], [1, 2, 3]))])
def test_ranks_are_open_where_one_draw_in_forty_changes_them(apart, ranks):
    """Two moduli of 10 % each differ by 14 %: 1.96 times that is 28 %. A third is far below."""
    moduli = 1e4 * np.exp([apart, 0.0, -3.0])
    half = np.exp(1.96 * 0.1)
    table = pd.DataFrame({"E_MPa": moduli, "E_low_MPa": moduli / half, "E_high_MPa": moduli * half})
    assert _ranks(table) == ranks


def test_differences_are_ratios_whose_intervals_add_as_squares(monkeypatch):
    moduli, half = np.array([12.0, 10.0, 9.9]) * 1e3, np.exp([0.03, 0.04, 0.04])
    rows = {"mix": ["a", "b", "c"], "temperature_C": 20.0, "frequency_Hz": 10.0, "E_MPa": moduli}
    conditions = pd.DataFrame(rows | {"E_low_MPa": moduli / half, "E_high_MPa": moduli * half})
    monkeypatch.setattr(Comparison, "conditions", conditions)
    monkeypatch.setattr(Comparison, "table", conditions)
    found = Comparison({}).differences
    assert list(zip(found["mix"], found["than"], found["told_apart"])) == [
        ("a", "b", True), ("a", "c", True), ("b", "c", False),
    ]  # fmt: skip
    first = 100.0 * (1.2 * np.exp([0.0, -0.05, 0.05]) - 1.0)
    ends = [f"stiffer{end}_percent" for end in ("", "_low", "_high")]
    np.testing.assert_allclose(found.loc[0, ends].astype(float), first, rtol=1e-12)
    assert (found["temperature_C"] == 20.0).all() and (found["frequency_Hz"] == 10.0).all()


def test_conditions_are_those_that_the_tests_reach(monkeypatch):
    """15, 20, 40 and 50 degC at 10 Hz; |E*| is given here as a thousand times the temperature."""
    monkeypatch.setattr(comparison, "tested", lambda mix, t, f: (t < 45.0) & (f == 10.0))
    monkeypatch.setattr(comparison, "mix_modulus", lambda mix, t, f: (np.log(1e9 * t) + 0.1j,) * 3)
    one = SimpleNamespace(outcome=SimpleNamespace(mix=object()))
    found = Comparison({"m": one, "read": SimpleNamespace(outcome=SimpleNamespace(mix=None))}).conditions
    assert found[["mix", "temperature_C", "frequency_Hz", "E_MPa", "asked_for"]].to_numpy().tolist() == [
        ["m", 15.0, 10.0, pytest.approx(15e3), "stiffness, EN 12697-26"],
        ["m", 20.0, 10.0, pytest.approx(20e3), "fatigue"],
        ["m", 40.0, 10.0, pytest.approx(40e3), "rutting"],
    ]


def test_the_draws_of_one_machine_are_those_asked_for(monkeypatch):
    asked = []
    monkeypatch.setattr(comparison, "pool", lambda *given: asked.append(given) or "pooled")
    one, read = (SimpleNamespace(outcome=SimpleNamespace(diagnosis=made)) for made in ("made", None))
    assert Comparison({"a": one, "b": one}).same_machine(an.Draws(700, 3)) == "pooled"
    assert asked == [({"a": "made", "b": "made"}, 700, 3)]
    with pytest.raises(an.InputError, match="read from files"):
        Comparison({"a": one, "b": read}).same_machine()


def test_progress_of_one_mix_is_a_part_of_all():
    told = []
    _part_of(lambda *said: told.append(said), 1, 4, "fit", 5.0, 10.0)
    assert told == [("Compare", 1.5, 4)]


def test_a_forecast_shows_what_was_computed(tmp_path, monkeypatch):
    grading = {19: 100, 9.5: 85, 4.75: 60, 2.36: 42, 0.6: 20, 0.15: 8, 0.075: 5}
    recipe = {
        "name": "a mix", "binder": {"grade": "PG 64-22"}, "binder_percent_by_mass": 5.2, "air_voids_percent": 7.0,
        "grading": grading, "temperatures_C": [21.1], "frequencies_Hz": [1.0, 10.0],
    }  # fmt: skip
    found, asked = forecast(recipe_of(recipe)), []
    monkeypatch.setattr(forecasting, "forecast_of", lambda recipe: asked.append(recipe) or found)
    mix = an.forecast(recipe)
    assert repr(asked) == repr([found.recipe])
    assert_frame_equal(mix.table, written.points(found))
    assert_frame_equal(mix.rivals, written.rival_points(found))
    assert mix.law.content == written.law_of_mix(found) and mix.summary == written.summary(found)
    low, high = sorted(mix.table["E_MPa"])
    assert repr(mix) == f"Forecast(a mix: 2 points, {low:.0f} to {high:.0f} MPa)"
    assert all((tmp_path / "out" / name).is_file() for name in mix.write(tmp_path / "out"))
