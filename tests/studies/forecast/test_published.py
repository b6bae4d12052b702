"""What README and docs/forecast.md say of the published forecasts is what the table holds."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.forecasting.forecast import MODEL
from forecast.blind import overall

ROOT = Path(__file__).parents[3]
OVERALL = pd.read_csv(ROOT / "results/published/forecast/mixes/overall.csv").set_index("forecast")
FORECAST = "+ air voids: the forecast"


BLIND = pd.read_csv(ROOT / "results/published/forecast/blind_overall.csv").set_index(
    ["temperature_C", "model"]
)
WARM = BLIND.loc["4.4 to 54.4"]
MIXES = pd.read_csv(ROOT / "results/published/forecast/blind_mixes.csv")


def page(name: str) -> str:
    return " ".join((ROOT / name).read_text(encoding="utf-8").split())


def test_blind_errors_in_the_readme():
    own, hirsch, text = WARM.loc["forecast"], WARM.loc["hirsch"], page("README.md")
    assert f"For {own.mixes:.0f} measured mixes that it had never seen" in text
    assert f"misses |E\\*| by a factor of {own.factor:.2f} and the phase by {own.phase_deg:.1f}°" in text
    assert f"misses by {hirsch.factor:.2f} and {hirsch.phase_deg:.1f}°: use that" in text
    told = f"Witczak's misses by {WARM.factor['witczak']:.2f}, a differential scheme by"
    cold = BLIND.factor["4.4", "differential"]
    assert f"{told} {WARM.factor['differential']:.1f}, but by {cold:.2f} at 4.4 °C" in text


def test_blind_errors_in_the_docs():
    own, hirsch, text = WARM.loc["forecast"], WARM.loc["hirsch"], page("docs/forecast.md")
    refused = MIXES.refused.dropna()
    assert (
        f"Of {len(MIXES)} other mixes" in text
        and f"it takes {own.mixes:.0f} and refuses {len(refused)}" in text
    )
    assert f"misses |E\\*| by a factor of {own.factor:.2f} and the phase by {own.phase_deg:.1f}°" in text
    assert f"nearer than Hirsch in {own.mixes_nearer_than_hirsch:.0f} mix of {own.mixes:.0f}" in text
    assert f"misses by a factor of {hirsch.factor:.2f} and {hirsch.phase_deg:.1f}°" in text
    assert (
        f"holds {100 * own.E_in_band:.0f} % of the moduli and {100 * own.phase_in_band:.0f} % of the phases"
        in text
    )
    assert refused.str.contains("aggregate fills").sum() == 3 and "three mixes with more than 92 %" in text
    assert (
        refused.str.contains("mortar fill 70 %").sum() == 1
        and "one whose sand fills 70 % of its mortar" in text
    )
    for temperature in ("-10", "4.4"):
        assert (
            BLIND.factor[temperature][["forecast", "hirsch", "witczak", "differential"]].idxmin()
            == "differential"
        )


def test_each_mix_has_the_version_that_first_saw_it():
    seen = pd.read_csv(ROOT / "data/mixes50/seen.csv").set_index("mix").version
    assert (MIXES.set_index("mix").version == seen).all() and seen.str.fullmatch("[0-9a-f]{40}").all()


def test_blind_tables_are_made_of_the_published_points():
    points = pd.read_csv(ROOT / "results/published/forecast/blind.csv")
    found = overall(points).set_index(["temperature_C", "model"])
    assert found.factor.to_numpy() == pytest.approx(BLIND.factor.to_numpy(), rel=1e-8)
    assert found.phase_deg.to_numpy() == pytest.approx(BLIND.phase_deg.to_numpy(), rel=1e-8, nan_ok=True)


def test_errors_on_the_six_mixes():
    row, text = OVERALL.loc[FORECAST], page("docs/forecast.md")
    assert (
        f"within a factor of {row.factor_all:.2f} and {row.phase_all_deg:.1f}° is no proof of skill" in text
    )
    printed = OVERALL.loc["aggregate 95 GPa, as the source prints"]
    assert f"is off by {printed.factor_all:.2f} and {printed.phase_all_deg:.1f}°" in text
    assert f"is off by {OVERALL.factor_all['differential']:.2f}, with Rigden's filler by" in text
    assert f"filler by {OVERALL.factor_all['differential, filler by Rigden']:.2f}" in text


def test_a_measured_map_does_as_well():
    text = page("docs/forecast.md")
    own = OVERALL[OVERALL.index.str.startswith("no particle")].iloc[0]
    told = [
        f"{100 * own[f'factor_{mix}'] - 100:.0f} % and {own[f'phase_{mix}_deg']:.1f}°" for mix in ("H3", "H9")
    ]
    assert f"meets H3 within {told[0]}, and H9 within {told[1]}" in text
    shifted = OVERALL[OVERALL.index.str.startswith("that map")].iloc[0]
    assert f"within a factor of {shifted.factor_all:.2f} and {shifted.phase_all_deg:.1f}°" in text
    assert shifted.name.split()[-3] in text.split("With their binders ")[1][:5]
    hot = OVERALL[OVERALL.index.str.startswith("binder ")].iloc[0]
    worst, phase = hot[["factor_H3", "factor_H9"]].max(), hot[["phase_H3_deg", "phase_H9_deg"]].max()
    assert f"within {100 * (worst - 1):.0f} % and {phase:.1f}°." in text
    hot_mixes = OVERALL[["factor_H0", "factor_H3", "factor_H9"]]
    assert (hot_mixes.loc["hirsch"] < hot_mixes.loc[FORECAST]).all()
    assert OVERALL.phase_all_deg["hirsch"] < OVERALL.phase_all_deg[FORECAST]


def test_what_the_doubts_alone_hold():
    bands = pd.read_csv(ROOT / "results/published/forecast/mixes/bands.csv")
    moduli, phases = 100 * bands.E_in_doubts.mean(), 100 * bands.phase_in_doubts.mean()
    assert f"hold {moduli:.0f} % of the moduli of the six mixes and {phases:.0f} % of the phases" in page(
        "docs/forecast.md"
    )


def test_the_model_of_the_band_is_what_the_table_says():
    row = OVERALL.loc[FORECAST]
    assert round(float(np.exp(MODEL.real)), 2) == round(row.factor_all, 2)
    assert round(float(np.degrees(MODEL.imag)), 1) == round(row.phase_all_deg, 1)


def test_how_far_the_cost_of_air_is_from_measured():
    table = pd.read_csv(ROOT / "results/published/forecast/voids.csv")
    off = (table["forecast_percent"] - table["measured_percent"]) / table["standard_error_percent"]
    text = " ".join((ROOT / "docs/forecast.md").read_text(encoding="utf-8").split())
    assert f"{off[:-1].min():.1f} to {off[:-1].max():.1f} standard errors off" in text
    assert f"probability of {table.iloc[-1].probability:.2f}" in text
