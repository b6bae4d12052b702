"""What a percent of air costs: the forecast against specimens of one mix that differ in their air voids.

The law of the binder cancels: each state is taken at the modulus of binder with which the forecast meets it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.formulation.forecast import Networks, Settings, modulus_of
from asphalt_nscd.formulation.recipe import Recipe

VOIDS = np.arange(0.03, 0.1201, 0.01)  # of the volume
BINDER = np.geomspace(1e4, 6e8, 60)  # Pa, |E*|
PHASE = np.radians(45.0)  # of the binder; 30 or 60 degrees change no slope by a tenth


def compare_voids(
    folder: str | Path, recipe: Recipe, networks: Networks, progress: Callable[[str, float, float], None]
) -> pd.DataFrame:
    """d ln|E*| / d air voids [% per %] at each temperature and frequency, measured and forecast.

    folder: tables MIX.csv (specimen, temperature_C, frequency_Hz, E_MPa) and volumetrics.csv (mix, specimen_id, Va_pct,
    with a blank for each underscore of MIX). Measured: regression within mixes, with its standard error. Conditions
    with fewer than four mixes are left out.
    """
    measured = _specimens(Path(folder))
    surface = []
    for k, air in enumerate(VOIDS):
        progress("air voids", k, VOIDS.size)
        levels = networks.chain(replace(recipe, voids=float(air)), Settings(), 1)
        surface.append(np.log(np.abs(modulus_of(levels, recipe.aggregate, BINDER * np.exp(1j * PHASE)))))
    progress("air voids", VOIDS.size, VOIDS.size)
    rows = []
    for (temperature, frequency), group in measured.groupby(["temperature_C", "frequency_Hz"]):
        if group["mix"].nunique() < 4:
            continue
        by_mix = group.groupby("mix")
        log = np.log(group["E_MPa"]) - np.log(group["E_MPa"]).groupby(group["mix"]).transform("mean")
        air = group["Va_pct"] - by_mix["Va_pct"].transform("mean")
        square = float((air**2).sum())
        slope = float((log * air).sum()) / square
        left = log - slope * air
        error = np.sqrt(float((left**2).sum()) / (len(group) - by_mix.ngroups - 1) / square)
        parts = [
            (float((air[rows.index] ** 2).sum()), _slope(np.array(surface), rows["E_MPa"], rows["Va_pct"]))
            for _, rows in by_mix
        ]
        weight, forecast = np.array(parts).T
        rows.append(
            {
                "temperature_C": temperature,
                "frequency_Hz": frequency,
                "specimens": len(group),
                "E_MPa": float(np.exp(np.log(group["E_MPa"]).mean())),
                "measured_percent": 100.0 * slope,
                "standard_error_percent": 100.0 * error,
                "forecast_percent": 100.0 * float((weight * forecast).sum() / weight.sum()),
            }
        )
    return pd.DataFrame(rows)


def _slope(surface: np.ndarray, modulus: pd.Series, voids: pd.Series) -> float:
    """Of one mix: per percent of air, at its mean |E*| [MPa] and mean air [%]."""
    air = float(voids.mean()) / 100.0
    at = np.array([np.interp(air, VOIDS, column) for column in surface.T])
    binder = np.interp(float(np.log(1e6 * modulus).mean()), at, np.log(BINDER))
    along = np.array([np.interp(binder, np.log(BINDER), row) for row in surface])
    low, high = max(air - 0.01, VOIDS[0]), min(air + 0.01, VOIDS[-1])
    return float((np.interp(high, VOIDS, along) - np.interp(low, VOIDS, along)) / (100.0 * (high - low)))


def _specimens(folder: Path) -> pd.DataFrame:
    """All tests of a campaign with the air voids of their specimens."""
    if not (folder / "volumetrics.csv").is_file():
        raise InputError(f"{folder}: holds no volumetrics.csv; give a folder as data/ncat.")
    air = pd.read_csv(folder / "volumetrics.csv", comment="#", dtype={"specimen_id": str})
    air["mix"] = air["mix"].str.replace(" ", "_")
    tables = []
    for mix in sorted(air["mix"].unique()):
        table = pd.read_csv(folder / f"{mix}.csv", comment="#", dtype={"specimen": str})
        tables.append(table.assign(mix=mix))
    tests = pd.concat(tables)
    found = tests.merge(air, left_on=["mix", "specimen"], right_on=["mix", "specimen_id"], how="left")
    lacking = found[found["Va_pct"].isna()]
    if len(lacking):
        row = lacking.iloc[0]
        raise InputError(
            f"{folder}/volumetrics.csv: no row for specimen {row.specimen} of {row.mix}; add it."
        )
    return found.reset_index(drop=True)
