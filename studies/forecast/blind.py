"""The forecast of measured mixes beside what others forecast, how its two set numbers came about, and what limits it.

Of the binder the viscosity of its grade is known, of the grading four sieves; the effective binder counts as binder.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
import yaml
from scipy.optimize import least_squares, minimize_scalar

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.commit import commit
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.binders import RHEOLOGICAL_INDEX, BinderLaw, crossover_of, shear_modulus
from asphalt_nscd.forecasting.forecast import forecast
from asphalt_nscd.forecasting.recipe import Recipe, recipe_of
from asphalt_nscd.forecasting.rivals import RIVALS, witczak
from asphalt_nscd.forecasting.scheme import USUAL, Settings, modulus_of_mix
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

DENSITY = {"aggregate": 2670.0, "binder": 1030.0}  # kg/m3, usual: the source gives volumes
SIEVES = (0.063, 0.15, 0.3, 0.6, 1.18, 2.36)  # mm, between and below those of the source
COLDEST = 0.0  # degC, of errors over all temperatures: a grade says little of what is colder
CALIBRATED = "witczak_its_own_binder"  # with |G*| and phase of the source, which were fitted to these mixes
SHIFTED = {"forecast": "forecast_shifted", "hirsch": "hirsch_shifted"}  # with one shift of time for each mix
# No forecast: laws of nine constants fitted to each mix, to all it measured or to |E*| alone.
FITTED = {"own_law": 1.0, "own_law_of_modulus": 0.0}
MODELS = ("forecast", *RIVALS, CALIBRATED, *SHIFTED.values(), *FITTED)
TRIED = {"contacts": (1.0, 1.2, 1.4, 1.6, 1.8), "gap": (1e-9, 10e-9, 30e-9, 100e-9)}
INDICES = (1.2, 1.4, 1.6, 1.8, 2.0, 2.2)  # of the binder's law
GOAL = {"factor": 1.6, "phase_deg": 5.5}
SOURCES = (193, 204, 213, 218, 229, 236)  # first mix of each run of numbers that share a grading or nearly
HELD = 0.95  # of other sources' errors, within the band that is then tried on a source
Usual = Mapping[str, Any]  # a recipe, for what a row lacks
Model = Callable[[Recipe], np.ndarray]  # E* [Pa] of a mix


@dataclass(frozen=True)
class AtPoints:
    """Stands for a law: E* (n,) [Pa] of the binder at the points of a recipe, and at raised frequencies."""

    crossover: np.ndarray
    index: float = RHEOLOGICAL_INDEX

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """Three times the shear modulus: a binder is nearly incompressible."""
        return 3.0 * shear_modulus(omega, self.crossover, self.index)


@dataclass(frozen=True)
class Known:
    """Likewise, whatever the frequency."""

    modulus: np.ndarray

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return self.modulus


def grading_of(row: Mapping[str, float]) -> dict[float, float]:
    """Percent that passes each sieve [mm]; a power of size goes through 4.75 and 0.075 mm."""
    middle, fine = 100.0 - row["retained_4p75mm_percent"], row["passing_0p075mm_percent"]
    power = np.log(middle / fine) / np.log(4.75 / 0.075)
    passing = {size: float(middle * (size / 4.75) ** power) for size in SIEVES}
    passing |= {0.075: fine, 4.75: middle, 9.5: 100.0 - row["retained_9p5mm_percent"]}
    passing |= {19.0: 100.0 - row["retained_19mm_percent"], 25.0: 100.0}
    return passing


def recipe_of_row(
    row: Mapping[str, float], points: pd.DataFrame, usual: Usual, index: float = RHEOLOGICAL_INDEX
) -> Recipe:
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
    crossover = points["binder_viscosity_Pa_s"].map(lambda viscosity: crossover_of(viscosity, index))
    law = cast(BinderLaw, AtPoints(crossover.to_numpy(), index))
    temperature, frequency = (points[name].to_numpy() for name in ("temperature_C", "frequency_Hz"))
    return replace(recipe, binder=law, temperature=temperature, frequency=frequency)


def forecast_mix(recipe: Recipe, points: pd.DataFrame) -> pd.DataFrame:
    """Measured and forecast |E*| [MPa] and phase [degrees] of each point."""
    made = forecast(recipe)
    half = made.band()
    table = points[["mix", "temperature_C", "frequency_Hz"]].copy()
    table["measured_E_MPa"], table["measured_phase_deg"] = points["E_MPa"], points["phase_deg"]
    fitted = 3e3 * points["binder_G_kPa"] * np.exp(1j * np.radians(points["binder_phase_deg"]))
    known = replace(recipe, binder=cast(BinderLaw, Known(fitted.to_numpy())))
    found = {"forecast": made.modulus, **{name: rival(recipe) for name, rival in RIVALS.items()}}
    found[CALIBRATED] = witczak(known)
    found[SHIFTED["forecast"]] = shifted(recipe, points, forecast_modulus)
    found[SHIFTED["hirsch"]] = shifted(recipe, points, RIVALS["hirsch"])
    found |= {name: own_law(points, weight) for name, weight in FITTED.items()}
    for name, modulus in found.items():
        phase = np.degrees(np.angle(modulus))
        table[f"{name}_E_MPa"] = 1e-6 * np.abs(modulus)
        # a regression of |E*| alone has no phase
        table[f"{name}_phase_deg"] = phase if phase.any() else np.nan
    table["half_band_ln_E"], table["half_band_phase_deg"] = half.real, np.degrees(half.imag)
    return table


def forecast_modulus(mix: Recipe, settings: Settings = USUAL) -> np.ndarray:
    """E* (n,) [Pa] that is forecast of a mix."""
    return modulus_of_mix(mix, mix.binder_modulus(), settings)


def shifted(recipe: Recipe, points: pd.DataFrame, model: Model) -> np.ndarray:
    """E* (n,) [Pa] with the shift of the binder's time, -2 to 2 decades, that meets |E*| above COLDEST best."""
    warm = (points["temperature_C"] > COLDEST).to_numpy()

    def made(decades: float) -> np.ndarray:
        crossover = cast(AtPoints, recipe.binder).crossover / 10.0**decades
        return model(replace(recipe, binder=cast(BinderLaw, AtPoints(crossover))))

    def misfit(decades: float) -> float:
        off = np.log(1e-6 * np.abs(made(decades)) / points["E_MPa"].to_numpy())
        return float((off[warm] ** 2).mean())

    best = minimize_scalar(misfit, bounds=(-2.0, 2.0), method="bounded", options={"xatol": 0.02})
    return made(float(best.x))


def own_law(points: pd.DataFrame, weight: float) -> np.ndarray:
    """E* (n,) [Pa] of the 2S2P1D law with a WLF shift nearest to a mix above COLDEST, its phase counted by `weight`.

    A linear material has the phase that its |E*| asks for (Kramers and Kronig): what such a law misses no linear
    forecast can meet.
    """
    temperature, omega = points["temperature_C"].to_numpy(), 2.0 * np.pi * points["frequency_Hz"].to_numpy()
    measured, warm = _measured(points), (points["temperature_C"] > COLDEST).to_numpy()

    def made(x: np.ndarray) -> np.ndarray:
        glassy, static, delta, tau, beta, c1, c2 = np.exp(x[:7])
        h, part = 1.0 / (1.0 + np.exp(-x[7:]))
        shift = WLF(float(c1), float(c2) + float(np.ptp(temperature)), float(np.median(temperature)))
        law = TwoS2P1D(static, glassy, h * part, h, delta, tau, beta, shift)
        return law.complex_modulus(omega, temperature)

    def off(x: np.ndarray) -> np.ndarray:
        away = np.log(made(x) / measured)[warm]
        return np.concatenate([away.real, weight * away.imag])

    start = np.array([*np.log([3e10, 1e8, 2.2, 0.05, 100.0, 12.0, 70.0]), 0.3, -0.5])
    reach = np.array([2.0, 12.0, 5.0, 20.0, 10.0, 3.0, 4.0, 6.0, 6.0])
    best = least_squares(off, start, bounds=(start - reach, start + reach), x_scale="jac").x
    return np.where(warm, made(best), np.nan)


def forecast_all(
    recipes: pd.DataFrame, moduli: pd.DataFrame, versions: Mapping[int, str], usual: Usual
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Points of all mixes that the forecast takes, and a row for each mix: why it was refused, or how far it is off.

    `versions` are those that first forecast a mix; of one that is not there it is this one.
    """
    tables, rows = [], []
    for recipe in recipes.to_dict("records"):
        points = moduli[moduli["mix"] == recipe["mix"]]
        mix = int(recipe["mix"])
        row = {"mix": mix, "version": versions.get(mix, commit()), "refused": ""}
        try:
            table = forecast_mix(recipe_of_row(recipe, points, usual), points)
        except InputError as error:
            rows.append(row | {"refused": str(error)})
            continue
        tables.append(table)
        found = errors(table[table["temperature_C"] > COLDEST]).set_index("model")
        own = {f"factor_{model}": factor for model, factor in found["factor"].items()}
        phases = {f"phase_{model}_deg": off for model, off in found["phase_deg"].dropna().items()}
        rows.append(row | own | phases)
    return pd.concat(tables), pd.DataFrame(rows)


def errors(table: pd.DataFrame) -> pd.DataFrame:
    """A row for each model: factor (exp of the root mean square of ln(|E*| / measured)), bias, phase likewise."""
    rows = []
    for model in MODELS:
        off = np.log(table[f"{model}_E_MPa"] / table["measured_E_MPa"])
        turned = table[f"{model}_phase_deg"] - table["measured_phase_deg"]
        row = {"model": model, "points": len(table)}
        row |= {"factor": float(np.exp(np.sqrt((off**2).mean()))), "bias": float(np.exp(off.mean()))}
        row |= {"phase_deg": float(np.sqrt((turned**2).mean())), "phase_bias_deg": float(turned.mean())}
        if model == "forecast":
            row |= (_band_reached(table) <= 1.0).mean().to_dict()
        rows.append(row)
    return pd.DataFrame(rows)


def overall(points: pd.DataFrame) -> pd.DataFrame:
    """Errors of each model above COLDEST, and at each temperature; mixes nearer than Hirsch."""
    warm = points[points["temperature_C"] > COLDEST]
    parts = {f"{warm['temperature_C'].min():g} to {warm['temperature_C'].max():g}": warm}
    parts |= {f"{temperature:g}": part for temperature, part in points.groupby("temperature_C")}
    rows = []
    for name, part in parts.items():
        found = errors(part)
        each = {mix: errors(own).set_index("model")["factor"] for mix, own in part.groupby("mix")}
        by_mix = pd.DataFrame(each)
        found["mixes"] = by_mix.shape[1]
        found["mixes_nearer_than_hirsch"] = (by_mix < by_mix.loc["hirsch"]).sum(axis=1).to_numpy()
        rows.append(found.assign(temperature_C=name))
    return pd.concat(rows).set_index("temperature_C").reset_index()


def _measured(points: pd.DataFrame) -> np.ndarray:
    """E* (n,) [Pa]."""
    return 1e6 * points["E_MPa"].to_numpy() * np.exp(1j * np.radians(points["phase_deg"].to_numpy()))


def _off(
    recipes: pd.DataFrame, moduli: pd.DataFrame, usual: Usual, model: Model, index: float = RHEOLOGICAL_INDEX
) -> list[np.ndarray]:
    """ln(E* / measured) (n,) above COLDEST of each mix, by a model of a recipe, with an index of the binder's law."""
    off = []
    for row in recipes.to_dict("records"):
        points = moduli[(moduli["mix"] == row["mix"]) & (moduli["temperature_C"] > COLDEST)]
        off.append(np.log(model(recipe_of_row(row, points, usual, index)) / _measured(points)))
    return off


def _summed(off: list[np.ndarray]) -> dict[str, float]:
    log = np.concatenate(off)
    phase = float(np.degrees(np.sqrt((log.imag**2).mean())))
    return {"factor": float(np.exp(np.sqrt((log.real**2).mean()))), "phase_deg": phase}


def _cost(off: list[np.ndarray]) -> float:
    """How far from the goals, whose squares count alike."""
    found = _summed(off)
    modulus = np.log(found["factor"]) / np.log(GOAL["factor"])
    return float(modulus**2 + (found["phase_deg"] / GOAL["phase_deg"]) ** 2)


def try_numbers(
    recipes: pd.DataFrame, moduli: pd.DataFrame, usual: Usual, points: pd.DataFrame
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Errors above COLDEST for each pair of TRIED; and of each of SOURCES, with the pair that all others ask for.

    With it, of the published forecast's `points`, the shares within a band as wide as holds HELD of the others.
    """
    tried = {}
    for contacts, gap in product(TRIED["contacts"], TRIED["gap"]):
        model = partial(forecast_modulus, settings=Settings(contacts=contacts, gap=gap))
        tried[contacts, 1e9 * gap] = _off(recipes, moduli, usual, model)
    numbers = [{"contacts": c, "gap_nm": gap, **_summed(off)} for (c, gap), off in tried.items()]
    source = np.searchsorted(SOURCES, recipes["mix"], side="right")
    reached = _band_reached(points)
    of_point = np.searchsorted(SOURCES, points["mix"], side="right")
    rows, all_left, all_held = [], [], []
    for left in np.unique(source):
        mine, others = np.flatnonzero(source == left), np.flatnonzero(source != left)
        costs = {pair: _cost([off[k] for k in others]) if others.size else 0.0 for pair, off in tried.items()}
        pair = min(costs, key=costs.__getitem__)
        own = [tried[pair][k] for k in mine]
        wider = reached[of_point != left].quantile(HELD)
        held = reached[of_point == left] <= wider
        first, last = recipes["mix"][source == left].agg(["min", "max"])
        row = {"mixes": f"{first:.0f} to {last:.0f}", "contacts": pair[0], "gap_nm": pair[1]}
        rows.append(row | _summed(own) | held.mean().to_dict())
        all_left += own
        all_held.append(held)
    rows.append({"mixes": "all", **_summed(all_left), **pd.concat(all_held).mean().to_dict()})
    return pd.DataFrame(numbers), pd.DataFrame(rows)


def _band_reached(points: pd.DataFrame) -> pd.DataFrame:
    """Error over half width of the band, of modulus and phase (n, 2)."""
    off = np.log(points["forecast_E_MPa"] / points["measured_E_MPa"]).abs() / points["half_band_ln_E"]
    turned = (points["forecast_phase_deg"] - points["measured_phase_deg"]).abs()
    return pd.DataFrame({"E_in_band": off, "phase_in_band": turned / points["half_band_phase_deg"]})


def try_binders(recipes: pd.DataFrame, moduli: pd.DataFrame, usual: Usual) -> pd.DataFrame:
    """Errors above COLDEST of forecast and Hirsch for each of INDICES of the binder's law."""
    rows = []
    for index in INDICES:
        own = _off(recipes, moduli, usual, forecast_modulus, index)
        other = _off(recipes, moduli, usual, RIVALS["hirsch"], index)
        nearer = sum(_summed([a])["factor"] < _summed([b])["factor"] for a, b in zip(own, other, strict=True))
        beside = {f"hirsch_{name}": value for name, value in _summed(other).items()}
        rows.append({"index": index, **_summed(own), **beside, "mixes_nearer_than_hirsch": nearer})
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """From the files of the rule to its tables."""
    given, made = job.input, job.output
    usual = yaml.safe_load(Path(given.recipe).read_text(encoding="utf-8"))
    recipes, moduli, seen = (pd.read_csv(given[name]) for name in ("recipes", "moduli", "seen"))
    versions = dict(zip(seen["mix"], seen["version"], strict=True))
    points, mixes = forecast_all(recipes, moduli, versions, usual)
    tried, left_out = try_numbers(recipes, moduli, usual, points)
    tables = {"points": points, "mixes": mixes, "overall": overall(points), "tried": tried}
    tables |= {"left_out": left_out, "binders": try_binders(recipes, moduli, usual)}
    for name, table in tables.items():
        write_table(made[name], table)


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
