"""What a percent of air costs: the forecast against specimens of one mix that differ in their air voids.

The law of the binder cancels: each state is taken at the modulus of binder with which the forecast meets it. Air and
binder content are those of the specimens, the grading that of another recipe.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
from scipy.stats import t as student

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.binders import BinderLaw
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import hirsch, witczak
from asphalt_nscd.forecasting.scheme import modulus_of_mix

STEP = 0.01  # of the volume: slopes are taken between so much less air and so much more
PHASE = np.radians(45.0)  # 30 or 60 degrees change no slope by a tenth
BINDER = np.geomspace(1e4, 6e8, 60) * np.exp(1j * PHASE)  # Pa
Model = Callable[[Recipe], np.ndarray]
MODELS = {"forecast": lambda mix: modulus_of_mix(mix, BINDER), "hirsch": hirsch, "witczak": witczak}


@dataclass(frozen=True)
class AnyBinder:
    """Stands for a law: BINDER, whatever the frequency."""

    def complex_modulus(self, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return BINDER


def compare_voids(folder: str | Path, recipe: Recipe) -> pd.DataFrame:
    """d ln|E*| / d air voids [% per %], measured and by MODELS, in a row for each temperature and frequency.

    Measured: regression within mixes, with its standard error and the probability of a forecast as far off. Conditions
    with fewer than four mixes are left out. The last row is that of the means of each specimen, since what makes one
    stiff does so in all conditions. `folder` holds MIX.csv tables and volumetrics.csv (mix, specimen_id, Va_pct,
    VMA_pct; blanks for underscores of MIX; states of one section share the name before the last underscore).
    """
    tests = _specimens(Path(folder))
    by_condition = tests.groupby(["temperature_C", "frequency_Hz"])["mix"].transform("nunique")
    tests = tests[by_condition >= 4].reset_index(drop=True)
    tests["section"] = tests["mix"].str.rsplit("_", n=1).str[0]
    names = list(MODELS)
    tests[names] = 0.0
    for _, section in tests.groupby("section"):
        surfaces = _surfaces(section, recipe)
        for _, state in section.groupby(["mix", "temperature_C", "frequency_Hz"]):
            level = float(np.log(1e6 * state["E_MPa"]).mean())
            for name, found in surfaces.items():
                tests.loc[state.index, name] = rise(found, level) / (200.0 * STEP)
    condition = ["mix", "temperature_C", "frequency_Hz"]
    tests["log"] = np.log(tests["E_MPa"])
    # Less the means of its mix, whose unknown binder is then gone.
    for name in ("log", "Va_pct"):
        tests[name] -= tests.groupby(condition)[name].transform("mean")
    rows = [_row(at, group) for at, group in tests.groupby(condition[1:])]
    whole = tests.groupby(["mix", "specimen"])[["log", "Va_pct", "E_MPa", *names]].mean().reset_index()
    return pd.DataFrame([*rows, _row((np.nan, np.nan), whole)])


def _row(condition: tuple[float, float], group: pd.DataFrame) -> dict[str, Any]:
    """Regression of `log` on the air, both less the means of their mix, at a temperature and a frequency."""
    log, air = group["log"], group["Va_pct"]
    # A degree of freedom goes for the mean of each mix, and one for the slope.
    square, freedom = float((air**2).sum()), len(group) - group["mix"].nunique() - 1
    slope = float((log * air).sum()) / square
    error = float(np.sqrt(((log - slope * air) ** 2).sum() / freedom / square))
    expected = {name: float((air**2 * group[name]).sum()) / square for name in MODELS}
    off = abs(expected["forecast"] - slope) / error if error else np.inf
    return {
        "temperature_C": condition[0],
        "frequency_Hz": condition[1],
        "specimens": len(group),
        "E_MPa": float(np.exp(np.log(group["E_MPa"]).mean())),
        "measured_percent": 100.0 * slope,
        "standard_error_percent": 100.0 * error,
        **{f"{name}_percent": 100.0 * value for name, value in expected.items()},
        "probability": float(2.0 * student.sf(off, freedom)),
    }


def _surfaces(section: pd.DataFrame, recipe: Recipe) -> dict[str, np.ndarray]:
    """ln|E*| (3, b) of the mix of a section for each BINDER, at less air, its own and more, by each model."""
    air = float(section["Va_pct"].mean()) / 100.0
    # of the volume without air
    stone = float(((100.0 - section["VMA_pct"]) / (100.0 - section["Va_pct"])).mean())
    per_stone = (1.0 - stone) / stone * recipe.binder_density / recipe.aggregate_density
    own = replace(recipe, binder_share=per_stone / (1.0 + per_stone), binder=cast(BinderLaw, AnyBinder()))
    return {name: surface(model, own, "voids", air, STEP) for name, model in MODELS.items()}


def surface(model: Model, mix: Recipe, field: str, at: float, step: float) -> np.ndarray:
    """ln|E*| (3, b) of a mix for each BINDER, a step below a value of a field of its recipe, at it and above."""
    changes: list[dict[str, Any]] = [{field: value} for value in (at - step, at, at + step)]
    return np.log(np.abs(np.array([model(replace(mix, **change)) for change in changes])))


def rise(surface: np.ndarray, level: float) -> float:
    """Of ln|E*| over both steps, at the binder with which the mix has ln|E*| = level."""
    place = np.interp(level, surface[1], np.arange(BINDER.size))
    low, high = (np.interp(place, np.arange(BINDER.size), surface[k]) for k in (0, 2))
    return float(high - low)


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


def run(job: Any) -> None:
    """From the files of the rule to its tables."""
    campaign = Path(job.input.campaign[0]).parent
    write_table(job.output[0], compare_voids(campaign, read_recipe(job.input.recipe)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
