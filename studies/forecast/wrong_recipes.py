"""Recipes with one wrong input, drawn by two models that are not the forecast's, and what it names.

Truth: the differential scheme (McLaughlin 1977) for each level and the air voids, or Hirsch's regression; dry contacts
by Walton (1987) beside it. Aggregate and pressure of the truth are drawn anew for each mix, and so is scatter.
"""

import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.forecast import Networks, kept_in
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import hirsch
from forecast import wrong_inputs
from forecast.differential import differential

DRAWS = 50  # of each wrong input and size
TIMES = (0.0, 1.0, 2.0, 3.0)  # the limit
RELAXED = (20e6, 60e6)  # Pa, Young's modulus of the skeleton, as in published mixes
COORDINATION, PACKED = 4.5, 0.6  # of the dry skeleton


def skeleton(recipe: Recipe, pressure: float) -> float:
    """Young's modulus [Pa] of dry spheres that stick, under a pressure [Pa] (Walton 1987)."""
    shear, poisson = recipe.aggregate.shear, recipe.aggregate.poisson
    bulk = np.cbrt((PACKED * COORDINATION * shear / (1.0 - poisson)) ** 2 * pressure / (18.0 * np.pi**2))
    own_shear = 3.0 * (5.0 - 4.0 * poisson) / (5.0 * (2.0 - poisson)) * bulk
    return float(9.0 * bulk * own_shear / (3.0 * bulk + own_shear))


TRUTHS: dict[str, Callable[[Recipe], np.ndarray]] = {"differential": differential, "hirsch": hirsch}


def measured(
    truth: str, recipe: Recipe, name: str, size: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """ln(E* of a mix with a wrong input / of its reference), ln E* of the reference, ln of densities over the recipe's.

    All with scatter; that of the reference's level and tilt moves no point along its curve and is left out.
    """
    stone = replace(recipe.aggregate, modulus=rng.uniform(45e9, 75e9))
    right = replace(recipe, aggregate=stone)
    pressure = (rng.uniform(*RELAXED) / skeleton(right, 1.0)) ** 3
    other = wrong_inputs.changed(right, name, size)
    if name == "binder stiffness":
        other = replace(other, frequency=other.frequency * 10.0**size)
    pressed = pressure * 10.0**size if name == "dry contacts" else pressure
    model = TRUTHS[truth]
    known = np.log(model(right) + skeleton(right, pressure))
    ratio = np.log(model(other) + skeleton(other, pressed)) - known
    decades = np.log10(recipe.frequency)
    n, off = decades.size, rng.standard_normal
    level = wrong_inputs.LEVEL * off() + wrong_inputs.TILT * off() * (decades - decades.mean())
    phase = wrong_inputs.PHASE * off() + wrong_inputs.PHASE_POINT * off(n)
    ratio = ratio + level + wrong_inputs.POINT * off(n) + 1j * phase
    known = known + wrong_inputs.POINT * off(n) + 1j * wrong_inputs.PHASE_POINT * off(n)
    weighed = np.log(wrong_inputs.densities(other) / wrong_inputs.densities(recipe))
    return ratio, known, weighed + off(2) * [wrong_inputs.DENSITY, wrong_inputs.MAXIMUM]


def campaign(recipe: Recipe, changes: wrong_inputs.Changes, draws: int = DRAWS) -> pd.DataFrame:
    """A row for each truth, evidence, wrong input and size: how often it was named, and how."""
    rows = []
    for weighed in (False, True):
        limit = wrong_inputs.limits(changes, weighed)
        for truth in TRUTHS:
            for times in TIMES:
                for name in changes.size if times else ["none"]:
                    size = times * limit[name] if times else 0.0
                    if times and not size <= changes.size[name][-1]:
                        continue  # beyond what is tried
                    rng = np.random.default_rng([len(rows), draws])
                    found = []
                    for _ in range(draws if times else 4 * draws):
                        ratio, known, density = measured(truth, recipe, name, size, rng)
                        own = wrong_inputs.along_reference(changes, known)
                        found.append(wrong_inputs.find(own, ratio, density if weighed else None).inputs)
                    count = len(found)
                    rows.append(
                        {
                            "truth": truth,
                            "densities": "yes" if weighed else "no",
                            "wrong": name,
                            "limits": times,
                            "size": size,
                            "recipes": count,
                            "named": sum(one == (name,) for one in found) / count,
                            "among_several": sum(len(one) > 1 and name in one for one in found) / count,
                            "not_noticed": sum(not one for one in found) / count,
                            "named_wrongly": sum(bool(one) and name not in one for one in found) / count,
                        }
                    )
    return pd.DataFrame(rows)


if __name__ == "__main__":
    sys.stdout = sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    stated, packings = read_recipe(snakemake.input.recipe), kept_in(snakemake.input.packings)
    rates = campaign(stated, wrong_inputs.changes_of(stated, Networks(packings)))
    write_table(snakemake.output[0], rates)
    print(rates.to_string(index=False))
