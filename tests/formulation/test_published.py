"""What README and docs/forecast.md say of the published forecasts is what the table holds."""

from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).parents[2]
OVERALL = pd.read_csv(ROOT / "results/published/forecast/mixes/overall.csv").set_index("forecast")
FORECAST = "+ air voids: the forecast"


@pytest.mark.parametrize("page", ["README.md", "docs/forecast.md", "CHANGELOG.md"])
def test_errors_of_the_forecast(page):
    row = OVERALL.loc[FORECAST]
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    assert f"within a factor of {row.factor_all:.2f} and {row.phase_all_deg:.1f}°" in text


def test_hirsch_and_the_slower_binder():
    text = " ".join((ROOT / "docs/forecast.md").read_text(encoding="utf-8").split())
    hirsch = OVERALL.loc["hirsch"]
    assert f"{hirsch.factor_all:.2f} and {hirsch.phase_all_deg:.1f}°" in text
    slower = OVERALL[OVERALL.index.str.contains("decades slower")].iloc[0]
    decades = slower.name.split()[3]
    assert f"by {decades} decades of frequency" in text
    worst = max(slower.factor_W0, slower.factor_W3, slower.factor_W6)
    assert f"within a factor of {worst:.2f}" in text


def test_the_forecast_beats_rivals_of_as_many_parameters_in_modulus():
    rivals = OVERALL.loc[["mori_tanaka", "self_consistent", "hirsch", "witczak"], "factor_all"]
    assert OVERALL.loc[FORECAST, "factor_all"] < rivals.min()


def test_how_far_the_cost_of_air_is_from_measured():
    table = pd.read_csv(ROOT / "results/published/forecast/voids.csv")
    off = (table["forecast_percent"] - table["measured_percent"]) / table["standard_error_percent"]
    text = " ".join((ROOT / "docs/forecast.md").read_text(encoding="utf-8").split())
    assert f"{off.min():.1f} to {off.max():.1f} standard errors off" in text
