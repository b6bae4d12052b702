"""The forecast held against measurements: mixes drawn from the forecast itself are met, and one fault is found."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq
from scipy.stats import f

from asphalt_nscd.forecasting.recipe import read_recipe
from asphalt_nscd.forecasting.rivals import hirsch
from studies.forecast.mixes import best_map, compare, decades_slower, measured_map, overall, read_pairs
from studies.forecast.slopes import compare_slopes
from studies.forecast.voids import compare_voids


@pytest.fixture(scope="module")
def pairs():
    return read_pairs("data/forecast/binder_mix.csv", read_recipe("data/forecast/recipe.yaml"))


def test_pairs_are_read_with_their_laws(pairs):
    assert [pair.name for pair in pairs] == ["H0", "H3", "H9", "W0", "W3", "W6"]
    # 2S2P1D by hand at 1 rad/s, H0 of the table
    z = 1j * 0.834764484
    by_hand = 86.3470095 + (26000 - 86.3470095) / (
        1 + 2.52254414 * z**-0.22 + z**-0.65 + 1 / (43.3031679 * z)
    )
    found = pairs[0].mix.complex_modulus(1.0, 15.0)
    assert found == pytest.approx(1e6 * by_hand, rel=1e-9)


def test_warm_binders_are_slower_than_their_mixes_and_hot_ones_are_not(pairs):
    """Decades by which each is slower than H0, as docs/forecast.md tells them."""
    by_name = {pair.name: pair for pair in pairs}
    hot = by_name["H0"]

    told = {
        "H3": (0.41, 0.44),
        "H9": (0.76, 0.80),
        "W0": (0.82, -0.23),
        "W3": (1.55, 0.82),
        "W6": (2.37, 1.82),
    }
    for name, (binder, mix) in told.items():
        assert decades_slower(by_name[name].recipe.binder, hot.recipe.binder, hot) == pytest.approx(
            binder, abs=0.006
        )
        assert decades_slower(by_name[name].mix, hot.mix, hot) == pytest.approx(mix, abs=0.006)
    told_glass = [
        by_name[w].mix.glassy_modulus / by_name[h].mix.glassy_modulus
        for w, h in zip(("W0", "W3", "W6"), ("H0", "H3", "H9"), strict=True)
    ]
    assert told_glass == pytest.approx([0.81, 0.86, 0.91], abs=0.006)


def test_no_map_fits_warm_and_hot_mixes(pairs):
    """At equal modulus of the binder the mixes differ: the best map of the hot ones misses the warm ones."""

    def worst(of, on):
        from studies.forecast.mixes import _any_map

        weights = best_map([pair for pair in pairs if pair.name[0] == of])
        return max(
            np.sqrt((np.abs(np.log(_any_map(pair.binder()) @ weights / pair.measured)) ** 2).mean())
            for pair in pairs
            if pair.name[0] == on
        )

    assert worst("H", "H") < 0.06
    assert worst("H", "W") > 0.5


def test_the_map_of_a_mix_gives_that_mix(pairs):
    own = measured_map(pairs[0])
    assert np.abs(np.log(own(pairs[0].binder()) / pairs[0].measured)).max() < 1e-3
    softer = (np.abs(own(pair.binder()) / pair.measured).max() for pair in pairs[3:])
    assert max(softer) == pytest.approx(4.8, abs=0.05)  # as docs/forecast.md tells it


def test_errors_are_those_of_the_points(pairs):
    errors, points = compare(pairs[:1] + pairs[3:4])
    table = overall(errors).set_index("forecast")
    own = points[(points.forecast == "forecast") & (points.mix == "W0")]
    off = np.log(own.E_MPa / own.measured_E_MPa)
    assert table.factor_W0["forecast"] == pytest.approx(np.exp(np.sqrt((off**2).mean())))
    assert table.factor_H0[table.index.str.startswith("no recipe")].iloc[0] == pytest.approx(1.0, abs=1e-4)
    assert np.isnan(table.phase_all_deg["witczak"]) and table.parameters.max() == 35


def campaign(folder, slope):
    """Four mixes of three specimens whose |E*| loses `slope` percent with each percent of air."""
    rows = []
    for number in range(4):
        name = f"M{number}_RH"
        tests = []
        for specimen, air in zip("ABC", (6.0, 7.0, 8.0), strict=True):
            rows.append(
                {"mix": name.replace("_", " "), "specimen_id": specimen, "Va_pct": air, "VMA_pct": 10 + air}
            )
            modulus = 4000 * (1 + number) * np.exp(slope / 100 * air)
            tests.append(
                {
                    "specimen": specimen,
                    "temperature_C": 20,
                    "frequency_Hz": 1,
                    "E_MPa": modulus,
                    "phase_deg": 25,
                }
            )
        pd.DataFrame(tests).to_csv(folder / f"{name}.csv", index=False)
    pd.DataFrame(rows).to_csv(folder / "volumetrics.csv", index=False)


def test_cost_of_air_is_measured_within_mixes(tmp_path, recipe):
    campaign(tmp_path, -6.0)
    table = compare_voids(tmp_path, replace(recipe, voids=0.07))
    one, pooled = table.itertuples()
    for row in (one, pooled):
        assert row.measured_percent == pytest.approx(-6.0, abs=1e-9)
        assert row.standard_error_percent == pytest.approx(0.0, abs=1e-6)
        assert -30.0 < row.forecast_percent < 0.0 and -15.0 < row.hirsch_percent < -3.0
    assert (one.temperature_C, one.frequency_Hz) == (20, 1) and np.isnan(pooled.temperature_C)


def test_slopes_are_those_of_one_percent_at_the_measured_modulus(recipe):
    """By hand: Hirsch at one modulus of the binder, for a percent of air or half of one of binder to each side."""
    row = {
        "campaign": "c",
        "temperature_C": 20,
        "specimens": 9,
        "air_percent": 6.0,
        "binder_percent": 5.0,
        "E_MPa": 4e3,
    }
    row |= {f"{of}_{what}_percent": -9.0 for of in ("air", "binder") for what in ("slope", "error")}
    found = compare_slopes(pd.DataFrame([row]), recipe).set_index("of")
    own = replace(recipe, voids=0.06, binder_share=0.05)

    def modulus(mix, binder):
        known = type("", (), {"complex_modulus": lambda self, omega, temperature: np.array([binder + 0j])})()
        return float(np.abs(hirsch(replace(mix, binder=known)))[0])

    binder = brentq(lambda e: modulus(own, e) - 4e9, 1e5, 1e9)
    air = np.log(modulus(replace(own, voids=0.07), binder) / modulus(replace(own, voids=0.05), binder)) / 0.02
    more = np.log(
        modulus(replace(own, binder_share=0.055), binder) / modulus(replace(own, binder_share=0.045), binder)
    )
    assert found.hirsch["air"] == pytest.approx(air, rel=0.02) and found.hirsch["binder"] == pytest.approx(
        more / 0.01, rel=0.02
    )
    assert found.forecast["air"] < 0.0 and found.measured["binder"] == -9.0


def test_pooled_scatter_is_that_of_specimens(tmp_path, recipe):
    """A specimen that is stiff in every condition counts once: more conditions make no error smaller."""
    campaign(tmp_path, -6.0)
    table = pd.read_csv(tmp_path / "M2_RH.csv")
    table.loc[0, "E_MPa"] *= 1.1
    errors = []
    for conditions in (1, 3):
        for number in range(4):
            path = tmp_path / f"M{number}_RH.csv"
            first = table if number == 2 else pd.read_csv(path).query("frequency_Hz == 1")
            pd.concat([first.assign(frequency_Hz=10**k) for k in range(conditions)]).to_csv(path, index=False)
        errors.append(compare_voids(tmp_path, recipe).iloc[-1])
    assert errors[0].specimens == errors[1].specimens == 12
    assert errors[1].standard_error_percent == pytest.approx(errors[0].standard_error_percent, rel=1e-9)
    # the one deviation: -ln(1.1) a / sum of a^2 in the slope
    assert errors[0].measured_percent == pytest.approx(-6.0 - 100 * np.log(1.1) / 8, rel=1e-9)
    # twelve specimens less the means of four mixes and a slope
    error = 100 * np.log(1.1) * np.sqrt((2 / 3 - 1 / 8) / 7 / 8)
    assert errors[0].standard_error_percent == pytest.approx(error, rel=1e-9)
    off = (errors[0].forecast_percent - errors[0].measured_percent) / error
    assert errors[0].probability == pytest.approx(f.sf(off**2, 1, 7), rel=1e-9)
