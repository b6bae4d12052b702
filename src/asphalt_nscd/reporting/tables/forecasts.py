"""Forecasts of measured mixes from binder and recipe, beside those of others."""

from __future__ import annotations

from pathlib import Path

import pandas as pd


def make(overall: list[Path]) -> pd.DataFrame:
    """One row for each forecast: parameters that were fitted, and its errors over all mixes and for each.

    overall: overall.csv of the rule `forecast_mixes`.
    """
    return pd.read_csv(overall[0])
