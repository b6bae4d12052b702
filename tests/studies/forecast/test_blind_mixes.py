"""The forecast of mixes that it has not seen: what stands for their binder and grading, and how errors are counted."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.forecasting.forecast import Settings, modulus_of
from forecast.blind import (
    AtPoints,
    crossover_of,
    errors,
    forecast_all,
    grading_of,
    recipe_of_row,
    shear_modulus,
)
from forecast.differential import differential

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


def test_a_binder_that_crosses_over_is_half_way_between_glass_and_flow():
    at = shear_modulus(np.array([3.0]), 3.0)
    assert np.degrees(np.angle(at)) == pytest.approx(45.0)
    assert np.abs(at) == pytest.approx(1e9 * 10**-1.8)  # the rheological index is the decades below the glass
    assert shear_modulus(np.array([1e-20]), 3.0) == pytest.approx(1e9 / 3.0 * 1e-20 * 1j, rel=0.02)


@pytest.mark.parametrize("viscosity", [1e2, 1e5, 7e9])
def test_a_binder_has_the_viscosity_of_its_grade(viscosity):
    at = shear_modulus(np.array([10.0]), crossover_of(viscosity))
    found = np.abs(at) / 10.0 * (1.0 / np.sin(np.angle(at))) ** 4.8628
    assert found == pytest.approx(viscosity, rel=1e-6)


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


def test_a_mix_drawn_from_the_forecast_is_met_and_a_refused_one_is_named(content, points, networks):
    recipe = recipe_of_row(ROW, points, content)
    truth = modulus_of(networks.chain(recipe, Settings(), 1), recipe.aggregate, recipe.binder_modulus())
    drawn = points.assign(E_MPa=3e-6 * np.abs(truth), phase_deg=np.degrees(np.angle(truth)) + 3.0)
    lean = {**ROW, "mix": 8, "effective_binder_percent_by_volume": 2.0}
    moduli = pd.concat([drawn, drawn.assign(mix=8)])
    table, mixes = forecast_all(pd.DataFrame([ROW, lean]), moduli, {7: "abc"}, content, networks)
    found = errors(table).set_index("model").loc["forecast"]
    assert (found["factor"], found["bias"], found["phase_deg"]) == pytest.approx((3.0, 1 / 3, 3.0))
    assert (found["E_in_band"], found["phase_in_band"]) == (0.0, 1.0)
    assert mixes["mix"].tolist() == [7, 8] and mixes["version"][0] == "abc" and mixes["version"][1] != ""
    assert "aggregate fills" in mixes["refused"][1] and not mixes["refused"][0]
    assert mixes["factor_forecast"][0] == pytest.approx(3.0) and set(table["mix"]) == {7}


def test_the_differential_scheme_of_few_grains_is_einsteins(recipe):
    """1 + 2.5 phi in an incompressible matrix; with Rigden's voids the filler counts for more."""
    few = replace(recipe, voids=0.0, binder_share=0.98, binder=AtPoints(np.array([1e3 + 0j])))
    share = few.aggregate_fraction
    found = differential(few, 400)[0] / 1e3
    assert found.real == pytest.approx((1.0 - share) ** -2.5, rel=2e-3)
    filler = share * float(few.grading.passing_at(0.063e-3))
    more = differential(few, 400, rigden=0.35)[0] / 1e3
    assert more.real / found.real == pytest.approx(1.0 + 2.5 * filler * (1.0 / 0.65 - 1.0), rel=1e-3)
