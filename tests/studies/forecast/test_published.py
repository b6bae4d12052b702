"""What README and docs/forecast.md say of the published forecasts is what the tables hold."""

from pathlib import Path

import pandas as pd
import pytest

from studies.forecast.blind import overall

ROOT = Path(__file__).parents[3]
OVERALL = pd.read_csv(ROOT / "results/published/forecast/mixes/overall.csv").set_index("forecast")
BLIND = pd.read_csv(ROOT / "results/published/forecast/blind_overall.csv").set_index(
    ["temperature_C", "model"]
)
WARM = BLIND.loc["4.4 to 54.4"]
MIXES = pd.read_csv(ROOT / "results/published/forecast/blind_mixes.csv")


def page(name: str) -> str:
    return " ".join((ROOT / name).read_text(encoding="utf-8").split())


@pytest.mark.parametrize("name", ["README.md", "docs/forecast.md"])
def test_errors_on_the_mixes(name):
    own, hirsch, text = WARM.loc["forecast"], WARM.loc["hirsch"], page(name)
    assert f"misses |E\\*| by a factor of {own.factor:.2f} and the phase by {own.phase_deg:.1f}°" in text
    assert (
        f"misses by {hirsch.factor:.2f} and {hirsch.phase_deg:.1f}°" in text
        and f"{own.mixes:.0f} measured mixes" in text
    )
    assert MIXES.refused.isna().all() and own.mixes == len(MIXES) == 25


def test_what_the_docs_say_of_the_mixes():
    own, text = WARM.loc["forecast"], page("docs/forecast.md")
    assert f"in {own.mixes_nearer_than_hirsch:.0f} mixes of {own.mixes:.0f}" in text
    held = BLIND.xs("forecast", level="model")[["E_in_band", "phase_in_band"]]
    said = held.loc["4.4 to 54.4"]
    assert (
        f"holds {100 * said.E_in_band:.0f} % of the moduli and {100 * said.phase_in_band:.0f} % of the phases"
        in text
    )
    assert held.min().min() >= 0.9 and held.max().max() <= 0.995
    shifted = WARM.phase_deg[["forecast_shifted", "hirsch_shifted"]]
    assert f"leaves {shifted.iloc[0]:.1f}° (Hirsch {shifted.iloc[1]:.1f}°)" in text
    assert f"too low by {-BLIND.phase_bias_deg['-10', 'forecast']:.0f}° at -10 °C" in text


def test_each_mix_has_the_version_that_first_saw_it():
    seen = pd.read_csv(ROOT / "data/mixes50/seen.csv").set_index("mix").version
    assert (MIXES.set_index("mix").version == seen).all() and seen.str.fullmatch("[0-9a-f]{40}").all()


def test_blind_tables_are_made_of_the_published_points():
    points = pd.read_csv(ROOT / "results/published/forecast/blind.csv")
    found = overall(points).set_index(["temperature_C", "model"])
    assert found.factor.to_numpy() == pytest.approx(BLIND.factor.to_numpy(), rel=1e-8, nan_ok=True)
    assert found.phase_deg.to_numpy() == pytest.approx(BLIND.phase_deg.to_numpy(), rel=1e-8, nan_ok=True)


def test_errors_on_the_six_mixes():
    text = page("docs/forecast.md")
    best = OVERALL.factor_all["best map of binder to mix, fitted to all"]
    assert f"parameters, does better than {best:.2f} on all six" in text
    shifted = OVERALL[OVERALL.index.str.startswith("that map")].iloc[0]
    assert f"within a factor of {shifted.factor_all:.2f} and {shifted.phase_all_deg:.1f}°" in text
    assert f"{shifted.name.split()[-3]} decades of time softer" in text
    hot = OVERALL.loc["forecast", ["factor_H0", "factor_H3", "factor_H9"]]
    assert f"are met within {hot.min():.2f} to {hot.max():.2f} with 60 GPa" in text


def test_how_far_the_cost_of_air_is_from_measured():
    table = pd.read_csv(ROOT / "results/published/forecast/voids.csv")
    off = (table["forecast_percent"] - table["measured_percent"]) / table["standard_error_percent"]
    text = page("docs/forecast.md")
    assert f"{off[:-1].min():.1f} to {off[:-1].max():.1f} standard errors off" in text
    assert f"probability of {table.iloc[-1].probability:.2f}" in text
