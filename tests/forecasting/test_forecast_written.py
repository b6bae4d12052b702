"""What a forecast leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from forecasting.conftest import CONTENT

from asphalt_nscd.api.laws import Law
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import INPUTS, OF_THE_MODEL, forecast
from asphalt_nscd.forecasting.recipe import recipe_of
from asphalt_nscd.forecasting.scheme import Settings, modulus_of_mix
from asphalt_nscd.forecasting.written import (
    answer,
    caution,
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


def test_a_forecast_stands_with_its_band(found):
    """At two ends of the band, half way between two of its places, and where no phase can be."""
    size, phase = np.array([400e6, 2e9, 20e9, 1e6]), np.array([10.0, 40.0, 85.0, 50.0])
    recipe = replace(found.recipe, temperature=np.full(4, 15.0), frequency=np.arange(1.0, 5.0))
    frame = points(replace(found, recipe=recipe, modulus=size * np.exp(1j * np.radians(phase))))
    half, turn = np.array([1.1, 0.825, 0.6, 1.1]), np.array([15.0, 13.0, 6.0, 15.0])
    told = {
        "temperature_C": np.full(4, 15.0), "frequency_Hz": np.arange(1.0, 5.0),
        "E_MPa": [400, 2000, 20000, 1], "phase_deg": phase,
        "E_low_MPa": 1e-6 * size * np.exp(-half), "E_high_MPa": 1e-6 * size * np.exp(half),
        "phase_low_deg": [0, 27, 79, 35], "phase_high_deg": np.minimum(phase + turn, 90.0),
    }  # fmt: skip
    assert list(frame) == list(told)
    np.testing.assert_allclose(frame, np.transpose(list(told.values())))


def test_rivals_stand_beside_it_unless_stiffer_than_stone(found, monkeypatch):
    star = np.array([1e9, 59e9, 61e9, 1e8, 1e7]) * np.exp(0.5j)
    monkeypatch.setattr(written, "RIVALS", {"a": lambda recipe: star, "b": lambda recipe: np.abs(star) + 0j})
    frame = rival_points(found)
    for name in "ab":
        np.testing.assert_allclose(frame[f"{name}_E_MPa"], [1e3, 59e3, np.nan, 1e2, 10])
    np.testing.assert_allclose(frame["a_phase_deg"], np.degrees(0.5))
    assert "b_phase_deg" not in frame  # of |E*| alone
    np.testing.assert_allclose(frame["E_MPa"], 1e-6 * np.abs(found.modulus))
    np.testing.assert_allclose(frame["phase_deg"], np.degrees(np.angle(found.modulus)))


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


def test_the_summary_by_hand(graded):
    """Volumes of 5.4 % of binder and 6 % of air; means over all points; what the parts amplify."""
    made = forecast(graded)
    said = summary(made)
    by_mass = 5.4 / 1040, 94.6 / 2670
    solids, binder = (94 * share / sum(by_mass) for share in by_mass[::-1])
    shares = {"stones": 1 - 0.41238, "sand": 0.41238 - 0.0877, "filler": 0.0877}
    volumes = {name: share * solids for name, share in shares.items()} | {"binder": binder, "air": 6.0}
    assert said["volume_percent"] == pytest.approx(volumes)
    assert (said["vma_percent"], said["vfa_percent"]) == pytest.approx(
        (binder + 6, 100 * binder / (binder + 6))
    )
    for kind, names in (("inputs", INPUTS), ("of_the_model", OF_THE_MODEL)):
        for name, words in names.items():
            change = made.moved[name].mean()
            told = {"E_percent": 100 * np.expm1(change.real), "phase_deg": np.degrees(change.imag)}
            assert said[kind][words] == pytest.approx(told)
    sizes = {words: abs(one["E_percent"]) for words, one in said["inputs"].items()}
    assert said["largest"] == max(sizes, key=sizes.get) and said["kind"] == "forecast"
    order = answer(made)[-1].partition(": ")[2].rstrip(".").split("; ")
    assert [one.partition(":")[0] for one in order] == sorted(sizes, key=sizes.get, reverse=True)
    assert order[0].endswith(f"{said['inputs'][said['largest']]['E_percent']:+.1f} %")
    relaxed = modulus_of_mix(graded, np.array([1e-3]))[0].real
    assert said["relaxed_modulus_MPa"] == pytest.approx(1e-6 * relaxed)
    parts = {"volumes": Settings(contacts=0.0, pressure=0.0), "and contacts": Settings(pressure=0.0)}
    parts |= {"and dry skeleton": Settings()}
    assert said["amplification_of_binder_at_MPa"] == pytest.approx([0.1, 1, 10, 100, 1000])
    for name, settings in parts.items():
        binder = np.geomspace(1e5, 1e9, 5)
        over = np.abs(modulus_of_mix(graded, binder, settings)) / binder
        assert said["amplification"][name] == pytest.approx(over, abs=0.051)
    head = headline(made)
    first = f"|E*| = {head.E_MPa:.0f} MPa ({head.E_MPa / 6.894757:.0f} ksi) and phase {head.phase_deg:.1f}°"
    assert answer(made)[0].startswith(f"{first} at 15 °C (59 °F)")
