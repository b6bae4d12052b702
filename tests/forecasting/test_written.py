"""What a forecast leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from forecasting.conftest import CONTENT

from asphalt_nscd.api.laws import Law
from asphalt_nscd.forecasting.forecast import INPUTS, _changed, forecast
from asphalt_nscd.forecasting.recipe import recipe_of
from asphalt_nscd.forecasting.scheme import FILLER, USUAL
from asphalt_nscd.forecasting.written import (
    answer,
    caution,
    composition,
    design_points,
    headline,
    law_of_mix,
    points,
    rival_points,
    summary,
    write,
)


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
    for temperature in (25.0, 35.0):
        own = made.modulus_at(np.array([2 * np.pi]), temperature)
        assert np.abs(law.complex_modulus(np.array([1.0]), temperature) / own) == pytest.approx(1.0, abs=3e-3)


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
    assert table["E_psi_10_Hz"][70] == pytest.approx(at, abs=1.0)
    assert list(table.index) == [14, 40, 70, 100, 130] and set(table["binder"]) == {"known"}
    volumes = composition(made.recipe)
    assert sum(volumes.values()) == pytest.approx(1.0) and volumes["air"] == pytest.approx(0.06)
    said = summary(made)
    assert said["largest"] in said["inputs"] and said["relaxed_modulus_MPa"] > 10.0


@pytest.fixture(scope="module")
def graded():
    content = {name: value for name, value in CONTENT.items() if name != "angular_frequencies_rad_s"}
    return recipe_of(content | {"binder": {"grade": "PG 64-22"}})


def test_what_lies_beyond_the_table_of_a_binder_is_marked(graded):
    """Measured from 20 to 50 degC: 14, 40 and 130 degF are not, and neither is the headline."""
    made = forecast(
        replace(graded, measured=(20.0, 50.0), temperature=np.full_like(graded.temperature, 20.0))
    )
    marks = design_points(made).set_index("temperature_F")["binder"]
    assert [marks[f] for f in (14, 40, 70, 100, 130)] == ["extrapolated"] * 2 + ["known"] * 2 + [
        "extrapolated"
    ]
    told = caution(made)
    assert "from 20 to 50 °C: in the headline its law is extrapolated at 15 °C." in told
    assert (
        "in aashtoware.csv its law is extrapolated at -10, 4.44, 54.4 °C." in told
        and "forecast.csv" not in told
    )


def test_a_law_that_is_not_defined_in_the_cold_leaves_cells_empty(content):
    """C2 = 60 K about 60 degC: nothing is known at 0 degC and below; 15 degC is."""
    content["binder"] |= {"reference_temperature_C": 60, "shift": {"wlf_C1": 10, "wlf_C2_K": 60}}
    del content["angular_frequencies_rad_s"]
    made = forecast(recipe_of(content | {"temperatures_C": [20, 40, 60]}))
    table = design_points(made).set_index("temperature_F")
    assert (
        table.loc[14, "E_psi_0.1_Hz":"E_psi_25_Hz"].isna().all()
        and table["E_psi_25_Hz"].loc[40:].notna().all()
    )


def test_every_forecast_tells_the_same_state_first(found, graded):
    """15 degC and 10 Hz whatever points are asked; of a law without a shift its one temperature."""
    asked = replace(graded, temperature=np.array([30.0]), frequency=np.array([1.0]))
    state = headline(forecast(asked))
    direct = forecast(replace(graded, temperature=np.array([15.0]), frequency=np.array([10.0])))
    assert state[["temperature_C", "frequency_Hz"]].tolist() == [15.0, 10.0]
    for name in ("E_MPa", "phase_deg", "E_low_MPa", "phase_high_deg"):
        assert state[name] == pytest.approx(points(direct)[name][0])
    assert state["hirsch_E_MPa"] == pytest.approx(rival_points(direct)["hirsch_E_MPa"][0])
    assert answer(forecast(asked))[0].startswith(f"|E*| = {state.E_MPa:.0f} MPa")
    assert headline(found).temperature_C == found.recipe.binder.shift.reference_temperature


def test_what_each_input_moves_has_its_sign_and_the_model_is_apart(graded):
    said = summary(forecast(graded))
    more = forecast(replace(graded, voids=graded.voids + 0.005))
    change = np.expm1(np.log(np.abs(more.modulus / forecast(graded).modulus)).mean())
    assert said["inputs"]["the air voids, + 0.5 %"]["E_percent"] == pytest.approx(100 * change)
    signs = {name: np.sign(said["inputs"][words]["E_percent"]) for name, words in INPUTS.items()}
    assert (signs["voids"], signs["binder"], signs["stiffness"], signs["aggregate"]) == (-1, -1, 1, 1)
    assert "the number of contacts, x 1.5" in said["of_the_model"] and len(said["inputs"]) == 6


def test_volumes_and_what_a_grade_became_are_told(graded):
    """By hand: binder 5.4 / 1040 in 94.6 / 2670 and 6 % of air."""
    binder = 5.4 / 1040 / (5.4 / 1040 + 94.6 / 2670) * 94
    told = " ".join(answer(forecast(graded)))
    assert "Binder: A = 10.980, VTS = -3.680." in told
    assert f"VMA {binder + 6:.1f} %, VFA {100 * binder / (binder + 6):.0f} %" in told


def test_what_a_percent_of_filler_moves_is_of_one_percent():
    recipe = recipe_of(CONTENT)
    (more, _), before = _changed(recipe, USUAL)["filler"], recipe.grading.passing_at(FILLER)
    assert more.grading.passing_at(FILLER) - before == pytest.approx(0.01)
    assert INPUTS["filler"].endswith("+ 1 %") and more.binder_share == recipe.binder_share
