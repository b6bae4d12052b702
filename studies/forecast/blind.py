"""The forecast as it stands, of measured mixes on which none of its rules was chosen, beside what others forecast.

Of the binder the viscosity of its grade is known, of the grading four sieves; the effective binder counts as binder.
Packings are those of another recipe, whatever the grading.
"""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
import yaml
from scipy.optimize import brentq

from asphalt_nscd.files.commit import commit
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.forecast import (
    MODEL,
    Contents,
    Level,
    LevelPacking,
    Networks,
    forecast,
    kept_in,
)
from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe, recipe_of
from asphalt_nscd.forecasting.rivals import hirsch, witczak
from asphalt_nscd.rheology.spectrum import Spectrum
from forecast.differential import FINE, RIGDEN, differential

GLASSY, RHEOLOGICAL_INDEX = 1e9, 1.8  # Pa; Christensen & Anderson (1992), middle of paving grades
DENSITY = {"aggregate": 2670.0, "binder": 1030.0}  # kg/m3, usual: the source gives volumes
SIEVES = (0.063, 0.15, 0.3, 0.6, 1.18, 2.36)  # mm, between and below those of the source
COLDEST = 0.0  # degC, of errors over all temperatures: a grade says little of what is colder
RIVALS: dict[str, Callable[[Recipe], np.ndarray]] = {
    "hirsch": hirsch,
    "witczak": witczak,
    "differential": partial(differential, steps=FINE, rigden=RIGDEN),
}
CALIBRATED = "witczak_its_own_binder"  # with |G*| and phase of the source, which were fitted to these mixes


@dataclass(frozen=True)
class AtPoints:
    """Stands for a law: E* (n,) [Pa] of the binder at the points of a recipe."""

    modulus: np.ndarray

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return self.modulus


class ShippedPackings(Networks):
    """The packings of one recipe for the levels of any other."""

    def __init__(self, recipe: Recipe, folder: str | Path) -> None:
        super().__init__(kept_in(folder))
        self._own = {level.name: level for level in levels_of(recipe)}

    def _contents(self, level: Level, seed: int) -> tuple[LevelPacking, Contents]:
        return super()._contents(self._own[level.name], seed)


def shear_modulus(omega: np.ndarray, crossover: np.ndarray | float) -> np.ndarray:
    """G* (n,) [Pa] of a binder (Christensen & Anderson 1992) that crosses over at an angular frequency [rad/s]."""
    power = np.log10(2.0) / RHEOLOGICAL_INDEX
    size = GLASSY * (1.0 + (crossover / omega) ** power) ** (-1.0 / power)
    return size * np.exp(0.5j * np.pi / (1.0 + (omega / crossover) ** power))


def crossover_of(viscosity: float) -> float:
    """Angular frequency [rad/s] of the binder whose viscosity [Pa s] is |G*| / 10 (1 / sin delta)^4.8628 at 10 rad/s.

    So the MEPDG (2004) makes the viscosity of a grade from its tests by a rheometer.
    """

    def off(log: float) -> float:
        at = shear_modulus(np.array(10.0), 10.0**log)
        return float(np.log(np.abs(at) / 10.0 * np.sin(np.angle(at)) ** -4.8628 / viscosity))

    return float(10.0 ** brentq(off, -20.0, 20.0))


def grading_of(row: Mapping[str, float]) -> dict[float, float]:
    """Percent that passes each sieve [mm]; a power of size goes through 4.75 and 0.075 mm."""
    middle, fine = 100.0 - row["retained_4p75mm_percent"], row["passing_0p075mm_percent"]
    power = np.log(middle / fine) / np.log(4.75 / 0.075)
    passing = {size: float(middle * (size / 4.75) ** power) for size in SIEVES}
    passing |= {0.075: fine, 4.75: middle, 9.5: 100.0 - row["retained_9p5mm_percent"]}
    passing |= {19.0: 100.0 - row["retained_19mm_percent"], 25.0: 100.0}
    return passing


def recipe_of_row(row: Mapping[str, float], points: pd.DataFrame, usual: Mapping[str, Any]) -> Recipe:
    """The recipe of a mix, all that the row lacks from a `usual` one; `points` have the viscosity of its binder."""
    air, binder = row["air_voids_percent"] / 100.0, row["effective_binder_percent_by_volume"] / 100.0
    heavy = DENSITY["binder"] * binder
    share = heavy / (heavy + DENSITY["aggregate"] * (1.0 - air - binder))
    own = {
        "name": f"{row['mix']:.0f}",
        "grading": grading_of(row),
        "binder_percent_by_mass": 100.0 * share,
        "air_voids_percent": row["air_voids_percent"],
        "density_kg_m3": DENSITY,
    }
    recipe = recipe_of({**usual, **own}, f"mix {row['mix']:.0f}")
    crossover = points["binder_viscosity_Pa_s"].map(crossover_of).to_numpy()
    omega = 2.0 * np.pi * points["frequency_Hz"].to_numpy()
    # Three times the shear modulus: a binder is nearly incompressible.
    law = cast(Spectrum, AtPoints(3.0 * shear_modulus(omega, crossover)))
    temperature, frequency = (points[name].to_numpy() for name in ("temperature_C", "frequency_Hz"))
    return replace(recipe, binder=law, temperature=temperature, frequency=frequency)


def forecast_mix(recipe: Recipe, points: pd.DataFrame, networks: Networks) -> tuple[pd.DataFrame, float]:
    """Measured and forecast |E*| [MPa] and phase [degrees] of each point, and the fraction of the stones."""
    made = forecast(recipe, networks, seeds=(1,))
    half = made.band(MODEL)
    table = points[["mix", "temperature_C", "frequency_Hz"]].copy()
    table["measured_E_MPa"], table["measured_phase_deg"] = points["E_MPa"], points["phase_deg"]
    table["forecast_E_MPa"], table["forecast_phase_deg"] = _shown(made.modulus)
    table["half_band_ln_E"], table["half_band_phase_deg"] = half.real, np.degrees(half.imag)
    for name, rival in RIVALS.items():
        table[f"{name}_E_MPa"], table[f"{name}_phase_deg"] = _shown(rival(recipe))
    fitted = 3e3 * points["binder_G_kPa"] * np.exp(1j * np.radians(points["binder_phase_deg"]))
    known = replace(recipe, binder=cast(Spectrum, AtPoints(fitted.to_numpy())))
    table[f"{CALIBRATED}_E_MPa"], table[f"{CALIBRATED}_phase_deg"] = _shown(witczak(known))
    return table, made.levels[-1].level.fraction


def _shown(modulus: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """|E*| [MPa] and phase [degrees]; a regression of |E*| alone has no phase."""
    phase = np.degrees(np.angle(modulus))
    return 1e-6 * np.abs(modulus), phase if phase.any() else np.full(phase.shape, np.nan)


def forecast_all(
    recipes: pd.DataFrame,
    moduli: pd.DataFrame,
    versions: Mapping[int, str],
    usual: Mapping[str, Any],
    networks: Networks,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Points of all mixes that the forecast takes, and a row for each mix: why it was refused, or how far it is off.

    `versions` are those that first forecast a mix; of one that is not there it is this one.
    """
    tables, rows = [], []
    for recipe in recipes.to_dict("records"):
        points = moduli[moduli["mix"] == recipe["mix"]]
        row = {
            "mix": int(recipe["mix"]),
            "version": versions.get(int(recipe["mix"]), commit()),
            "refused": "",
        }
        try:
            table, stones = forecast_mix(recipe_of_row(recipe, points, usual), points, networks)
        except InputError as error:
            rows.append(row | {"refused": str(error)})
            continue
        tables.append(table)
        found = errors(table[table["temperature_C"] > COLDEST]).set_index("model")
        own = {f"factor_{model}": factor for model, factor in found["factor"].items()}
        phases = {f"phase_{model}_deg": off for model, off in found["phase_deg"].dropna().items()}
        rows.append(row | {"stones_percent": 100.0 * stones} | own | phases)
    return pd.concat(tables), pd.DataFrame(rows)


def errors(table: pd.DataFrame) -> pd.DataFrame:
    """A row for each model: factor (exp of the root mean square of ln(|E*| / measured)), bias, phase likewise."""
    rows = []
    for model in ("forecast", *RIVALS, CALIBRATED):
        off = np.log(table[f"{model}_E_MPa"] / table["measured_E_MPa"])
        turned = table[f"{model}_phase_deg"] - table["measured_phase_deg"]
        within = {}
        if model == "forecast":
            within = {
                "E_in_band": float((off.abs() <= table["half_band_ln_E"]).mean()),
                "phase_in_band": float((turned.abs() <= table["half_band_phase_deg"]).mean()),
            }
        rows.append(
            {
                "model": model,
                "points": len(table),
                "factor": float(np.exp(np.sqrt((off**2).mean()))),
                "bias": float(np.exp(off.mean())),
                "phase_deg": float(np.sqrt((turned**2).mean())),
                "phase_bias_deg": float(turned.mean()),
                **within,
            }
        )
    return pd.DataFrame(rows)


def overall(points: pd.DataFrame) -> pd.DataFrame:
    """Errors of each model above COLDEST, and at each temperature; mixes where it is nearer than Hirsch."""
    warm = points[points["temperature_C"] > COLDEST]
    parts = {f"{warm['temperature_C'].min():g} to {warm['temperature_C'].max():g}": warm}
    parts |= {f"{temperature:g}": part for temperature, part in points.groupby("temperature_C")}
    rows = []
    for name, part in parts.items():
        found = errors(part)
        by_mix = pd.DataFrame(
            {mix: errors(own).set_index("model")["factor"] for mix, own in part.groupby("mix")}
        )
        found["mixes"] = by_mix.shape[1]
        found["mixes_nearer_than_hirsch"] = (by_mix < by_mix.loc["hirsch"]).sum(axis=1).to_numpy()
        found["mixes_within_factor_of_six"] = (by_mix <= np.exp(MODEL.real)).sum(axis=1).to_numpy()
        rows.append(found.assign(temperature_C=name))
    return pd.concat(rows).set_index("temperature_C").reset_index()


if __name__ == "__main__":
    sys.stdout = sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    given, made = snakemake.input, snakemake.output
    networks = ShippedPackings(read_recipe(given.recipe), given.packings)
    usual = yaml.safe_load(Path(given.recipe).read_text(encoding="utf-8"))
    recipes, moduli, seen = (pd.read_csv(given[name]) for name in ("recipes", "moduli", "seen"))
    versions = dict(zip(seen["mix"], seen["version"], strict=True))
    points, mixes = forecast_all(recipes, moduli, versions, usual, networks)
    for name, table in {"points": points, "mixes": mixes, "overall": overall(points)}.items():
        write_table(made[name], table)
