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
from studies.forecast.voids import MODELS, AnyBinder, rise, surface

STEPS = {"air": ("voids", 0.01), "binder": ("binder_share", 0.005)}  # of a recipe, to each side


def compare_slopes(measured: pd.DataFrame, recipe: Recipe) -> pd.DataFrame:
    """A row for each campaign and each of STEPS: d ln|E*| [% per %], measured with its error, and by MODELS."""
    rows = []
    for campaign in measured.to_dict("records"):
        shares = campaign["air_percent"] / 100.0, campaign["binder_percent"] / 100.0
        binder = cast(BinderLaw, AnyBinder())
        own = replace(recipe, voids=shares[0], binder_share=shares[1], binder=binder)
        for quantity, (field, step) in STEPS.items():
            row = {key: campaign[key] for key in ("campaign", "temperature_C", "specimens")}
            row["of"] = quantity
            for name, kind in (("measured", "slope"), ("error", "error")):
                row[name] = campaign[f"{quantity}_{kind}_percent"]
            level = np.log(1e6 * campaign["E_MPa"])
            for name, model in MODELS.items():
                row[name] = rise(surface(model, own, field, getattr(own, field), step), level) / (2.0 * step)
            rows.append(row)
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """From the files of the rule to its table."""
    measured = pd.read_csv(job.input.slopes, comment="#")
    write_table(job.output[0], compare_slopes(measured, read_recipe(job.input.recipe)))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
