"""What a forecast leaves."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.api.laws import Law
from asphalt_nscd.forecasting.forecast import forecast
from asphalt_nscd.forecasting.recipe import recipe_of
from asphalt_nscd.forecasting.written import composition, law_of_mix, points, rival_points, summary, write


@pytest.fixture(scope="module")
def found(recipe):
    return forecast(recipe)


def test_forecast_has_a_band_that_holds_it(found):
    frame = points(found)
    assert (frame["E_low_MPa"] < frame["E_MPa"]).all() and (frame["E_MPa"] < frame["E_high_MPa"]).all()
    assert frame["E_MPa"].is_monotonic_increasing
    assert list(rival_points(found).columns[-5:]) == [
        "hirsch_E_MPa", "hirsch_phase_deg", "witczak_E_MPa", "differential_E_MPa", "differential_phase_deg"
    ]  # fmt: skip


def test_law_of_the_mix_follows_the_forecast(found):
    law = Law(law_of_mix(found))
    assert np.log(law.complex_modulus(found.recipe.frequency) / found.modulus) == pytest.approx(0.0, abs=2e-3)


def test_a_binder_of_few_temperatures_has_a_law_of_all(content):
    """Few points asked: further temperatures are forecast for the shift."""
    del content["angular_frequencies_rad_s"]
    asked = content | {"binder": {"grade": "64-22"}, "temperatures_C": [20], "frequencies_Hz": [10]}
    made = forecast(recipe_of(asked))
    law = Law(law_of_mix(made))
    cold = made.modulus_at(np.array([2 * np.pi]), 35.0)
    assert np.abs(law.complex_modulus(np.array([1.0]), 35.0) / cold) == pytest.approx(1.0, abs=0.1)


def test_files_of_a_design(content, tmp_path):
    """|E*| in psi at the temperatures and frequencies that AASHTOWare asks for."""
    del content["angular_frequencies_rad_s"]
    made = forecast(recipe_of(content | {"binder": {"grade": "PG 64-22"}}))
    assert write(made, tmp_path) == [
        "forecast.csv",
        "rivals.csv",
        "aashtoware.csv",
        "law.json",
        "forecast.json",
    ]
    table = pd.read_csv(tmp_path / "aashtoware.csv").set_index("temperature_F")
    at = np.abs(made.modulus_at(np.array([20 * np.pi]), (70 - 32) / 1.8))[0] / 6894.757
    assert table["E_psi_10_Hz"][70] == pytest.approx(at, abs=1.0) and list(table.index) == [
        14,
        40,
        70,
        100,
        130,
    ]
    volumes = composition(made.recipe)
    assert sum(volumes.values()) == pytest.approx(1.0) and volumes["air"] == pytest.approx(0.06)
    said = summary(made)
    assert said["largest"] in said["inputs"] and said["relaxed_modulus_MPa"] > 10.0
