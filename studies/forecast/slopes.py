"""What a percent of air and of binder cost: the forecast and its rivals beside regressions on measured stiffness.

The law of the binder cancels, as in `voids`: slopes are taken at the modulus of binder with which a model meets the
mean of the campaign. The grading is that of another recipe.
"""

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pandas as pd

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.binders import BinderLaw
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import hirsch, witczak
from asphalt_nscd.forecasting.scheme import modulus_of_mix
from studies.forecast.voids import BINDER, AnyBinder

MODELS = {"forecast": lambda mix: modulus_of_mix(mix, BINDER), "hirsch": hirsch, "witczak": witczak}
STEPS = {"air": ("voids", 0.01), "binder": ("binder_share", 0.005)}  # of a recipe, to each side


def compare_slopes(measured: pd.DataFrame, recipe: Recipe) -> pd.DataFrame:
    """A row for each campaign and each of STEPS: d ln|E*| [% per %], measured with its error, and by MODELS."""
    rows = []
    for campaign in measured.to_dict("records"):
        own = replace(
            recipe,
            voids=campaign["air_percent"] / 100.0,
            binder_share=campaign["binder_percent"] / 100.0,
            binder=cast(BinderLaw, AnyBinder()),
        )
        for name, (field, step) in STEPS.items():
            row = {key: campaign[key] for key in ("campaign", "temperature_C", "specimens")} | {"of": name}
            row |= {"measured": campaign[f"{name}_slope_percent"], "error": campaign[f"{name}_error_percent"]}
            for model, modulus in MODELS.items():
                at = getattr(own, field)
                logs = [
                    np.log(np.abs(modulus(replace(own, **{field: value}))))
                    for value in (at - step, at, at + step)
                ]
                place = np.interp(np.log(1e6 * campaign["E_MPa"]), logs[1], np.arange(BINDER.size))
                low, high = (np.interp(place, np.arange(BINDER.size), logs[k]) for k in (0, 2))
                row[model] = float(high - low) / (2.0 * step)
            rows.append(row)
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """From the files of the rule to its table."""
    measured = pd.read_csv(job.input.slopes, comment="#")
    write_table(job.output[0], compare_slopes(measured, read_recipe(job.input.recipe)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
