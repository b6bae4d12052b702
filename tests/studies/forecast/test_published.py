"""What README and docs/forecast.md say of the published forecasts is what the table holds."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.forecasting.forecast import MODEL

ROOT = Path(__file__).parents[3]
OVERALL = pd.read_csv(ROOT / "results/published/forecast/mixes/overall.csv").set_index("forecast")
FORECAST = "+ air voids: the forecast"


@pytest.mark.parametrize("page", ["README.md", "docs/forecast.md", "CHANGELOG.md"])
def test_errors_of_the_forecast(page):
    row = OVERALL.loc[FORECAST]
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    assert f"within a factor of {row.factor_all:.2f} and {row.phase_all_deg:.1f}°" in text


def test_what_is_set_on_one_mix():
    text = " ".join((ROOT / "docs/forecast.md").read_text(encoding="utf-8").split())
    hot = OVERALL[OVERALL.index.str.startswith("binder ")].iloc[0]
    blind = hot[["phase_H3_deg", "phase_H9_deg"]].max()
    assert (
        f"H3 and H9 are within {100 * (hot[['factor_H3', 'factor_H9']].max() - 1):.0f} % and {blind:.1f}°"
        in text
    )
    warm = OVERALL[OVERALL.index.str.endswith("set on W0")].iloc[0]
    worst, phase = (
        max(warm[f"{kind}_{mix}{unit}"] for mix in ("W3", "W6"))
        for kind, unit in (("factor", ""), ("phase", "_deg"))
    )
    assert f"W3 and W6 are within {100 * (worst - 1):.0f} % and {phase:.1f}°" in text


def test_the_model_of_the_band_is_what_the_table_says():
    row = OVERALL.loc[FORECAST]
    assert round(float(np.exp(MODEL.real)), 2) == round(row.factor_all, 2)
    assert round(float(np.degrees(MODEL.imag)), 1) == round(row.phase_all_deg, 1)


def test_the_forecast_beats_rivals_of_as_many_parameters_in_modulus():
    rivals = OVERALL.loc[["mori_tanaka", "self_consistent", "hirsch", "witczak"], "factor_all"]
    assert OVERALL.loc[FORECAST, "factor_all"] < rivals.min()


def test_how_far_the_cost_of_air_is_from_measured():
    table = pd.read_csv(ROOT / "results/published/forecast/voids.csv")
    off = (table["forecast_percent"] - table["measured_percent"]) / table["standard_error_percent"]
    text = " ".join((ROOT / "docs/forecast.md").read_text(encoding="utf-8").split())
    assert f"{off[:-1].min():.1f} to {off[:-1].max():.1f} standard errors off" in text
    assert f"probability of {table.iloc[-1].probability:.2f}" in text
