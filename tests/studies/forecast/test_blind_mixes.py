"""The forecast of mixes that it has not seen: what stands for their binder and grading, and how errors are counted."""

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.forecasting.binders import ViscosityShift, crossover_of, shear_modulus
from asphalt_nscd.forecasting.scheme import modulus_of_mix
from studies.forecast.blind import (
    errors,
    forecast_all,
    grading_of,
    own_law,
    recipe_of_row,
    shifted,
    try_binders,
    try_numbers,
)

ROW = {
    "mix": 7,
    "retained_19mm_percent": 0.0,
    "retained_9p5mm_percent": 16.0,
    "retained_4p75mm_percent": 33.0,
    "passing_0p075mm_percent": 5.0,
    "air_voids_percent": 6.0,
    "effective_binder_percent_by_volume": 11.0,
}


@pytest.fixture
def points():
    """Two points of the binder of a PG 64-22, whose phase and modulus are those of its viscosity."""
    return pd.DataFrame(
        {
            "mix": 7,
            "temperature_C": [4.4, 37.8],
            "frequency_Hz": [10.0, 1.0],
            "E_MPa": [15000.0, 1500.0],
            "phase_deg": [12.0, 30.0],
            "binder_viscosity_Pa_s": [1e8, 1e4],
            "binder_G_kPa": [50000.0, 100.0],
            "binder_phase_deg": [30.0, 65.0],
        }
    )


def test_a_grading_goes_through_its_sieves_and_between_them_straight_over_logarithms():
    passing = grading_of(ROW)
    assert [passing[size] for size in (0.075, 4.75, 9.5, 19.0)] == [5.0, 67.0, 84.0, 100.0]
    middle = np.sqrt(4.75 * 0.075)
    power = np.log(67 / 5) / np.log(4.75 / 0.075)
    assert 67 * (middle / 4.75) ** power == pytest.approx(np.sqrt(67 * 5))
    assert passing[0.6] == pytest.approx(67 * (0.6 / 4.75) ** power)


def test_effective_binder_is_the_binder(content, points):
    recipe = recipe_of_row(ROW, points, content)
    binder = (1.0 - recipe.aggregate_fraction) * (1.0 - recipe.voids)
    assert (100.0 * binder, 100.0 * recipe.voids) == pytest.approx((11.0, 6.0))
    assert recipe.temperature.tolist() == [4.4, 37.8] and recipe.frequency.tolist() == [10.0, 1.0]
    assert np.abs(recipe.binder_modulus()[1]) == pytest.approx(
        3 * np.abs(shear_modulus(np.array([2 * np.pi]), crossover_of(1e4)))[0]
    )


def test_a_mix_drawn_from_the_forecast_is_met_and_a_refused_one_is_named(content, points):
    recipe = recipe_of_row(ROW, points, content)
    truth = modulus_of_mix(recipe, recipe.binder_modulus())
    drawn = points.assign(E_MPa=3e-6 * np.abs(truth), phase_deg=np.degrees(np.angle(truth)) + 3.0)
    lean = {**ROW, "mix": 8, "effective_binder_percent_by_volume": 1.0}
    moduli = pd.concat([drawn, drawn.assign(mix=8)])
    table, mixes = forecast_all(pd.DataFrame([ROW, lean]), moduli, {7: "abc"}, content)
    found = errors(table).set_index("model").loc["forecast"]
    assert (found["factor"], found["bias"], found["phase_deg"]) == pytest.approx((3.0, 1 / 3, 3.0))
    assert (found["E_in_band"], found["phase_in_band"]) == (0.0, 1.0)
    assert mixes["mix"].tolist() == [7, 8] and mixes["version"][0] == "abc" and mixes["version"][1] != ""
    assert "aggregate fills" in mixes["refused"][1] and not mixes["refused"][0]
    assert mixes["factor_forecast"][0] == pytest.approx(3.0) and set(table["mix"]) == {7}
    both = pd.DataFrame([ROW, {**ROW, "mix": 8}])
    tried, left_out = try_numbers(both, moduli, content, table)
    row = tried[(tried.contacts == 1.4) & np.isclose(tried.gap_nm, 10.0)].iloc[0]
    assert (row.factor, row.phase_deg) == pytest.approx((3.0, 3.0), rel=1e-6)
    assert left_out["mixes"].tolist() == ["7 to 8", "all"] and (left_out.factor[0], left_out.E_in_band[0]) > (
        1.0,
        0.0,
    )
    binders = try_binders(both, moduli, content).set_index("index")
    assert binders.factor[1.8] == pytest.approx(3.0) and (binders.factor.drop(1.8) - 3.0).abs().min() > 0.01


def test_a_law_of_each_mix_meets_a_linear_mix_alone(content, points):
    """A linear mix is met in modulus and phase, by its modulus alone too; ten degrees above that are not."""
    grid = pd.DataFrame(
        [(t, f) for t in (4.4, 21.1, 37.8, 54.4) for f in (0.1, 1.0, 10.0)],
        columns=["temperature_C", "frequency_Hz"],
    )
    at = grid.assign(binder_viscosity_Pa_s=grid["temperature_C"].map(ViscosityShift(10.98, -3.68).viscosity))
    recipe = recipe_of_row(ROW, at, content)
    truth = modulus_of_mix(recipe, recipe.binder_modulus())
    linear = at.assign(E_MPa=1e-6 * np.abs(truth), phase_deg=np.degrees(np.angle(truth)))
    for weight, reach in ((1.0, 0.02), (0.0, 0.06)):
        assert np.sqrt((np.abs(np.log(own_law(linear, weight) / truth)) ** 2).mean()) < reach
    turned = np.degrees(np.angle(own_law(linear.assign(phase_deg=linear.phase_deg + 10.0), 0.0)))
    assert np.abs(turned - linear.phase_deg - 10.0).min() > 5.0


def test_a_shift_of_time_is_found(content, points):
    """A mix whose binder is a decade stiffer than its grade is met with that shift."""
    recipe = recipe_of_row(ROW, points, content)
    stiff = recipe_of_row(ROW, points.assign(binder_viscosity_Pa_s=[1e9, 1.2e5]), content)

    def made(mix):
        return modulus_of_mix(mix, mix.binder_modulus())

    drawn = points.assign(E_MPa=1e-6 * np.abs(made(stiff)))
    off = np.log(np.abs(shifted(recipe, drawn, made)) / 1e6 / drawn["E_MPa"])
    assert np.abs(off).max() < 0.3 < np.abs(np.log(np.abs(made(recipe) / made(stiff)))).max()
