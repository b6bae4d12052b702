"""Blind campaign: recipes with one wrong input, drawn by two models that are not the forecast's, and what it names.

    PYTHONPATH=trials python -m wrong_recipes --packings FOLDER --output TABLE

Truth: the differential scheme (McLaughlin 1977) for each level and the air voids, or Hirsch's regression; dry contacts
by Walton (1987) beside it. Aggregate and pressure of the truth are drawn anew for each mix, and so is scatter.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.forecasting import wrong_inputs
from asphalt_nscd.forecasting.forecast import Networks, kept_in
from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import BINDER_BULK, hirsch

STEPS = 60  # of the differential scheme
TIMES = (0.0, 1.0, 2.0, 3.0)  # the limit
RELAXED = (20e6, 60e6)  # Pa, Young's modulus of the skeleton, as in published mixes
COORDINATION, PACKED = 4.5, 0.6  # of the dry skeleton


def differential(recipe: Recipe) -> np.ndarray:
    """E* [Pa]: grains of each level, then voids, added bit by bit to what is there."""
    young, stone = recipe.binder_modulus(), recipe.aggregate
    bulk = np.full(young.shape, BINDER_BULK, complex)
    shear = 3.0 * bulk * young / (9.0 * bulk - young)
    parts = [(level.fraction, stone.bulk, stone.shear) for level in levels_of(recipe)]
    for fraction, own_bulk, own_shear in [*parts, (recipe.voids, 0.0, 0.0)]:
        step = -np.log(1.0 - fraction) / STEPS
        for _ in range(STEPS):
            around = shear * (9.0 * bulk + 8.0 * shear) / (6.0 * (bulk + 2.0 * shear))
            soft = (
                1.0 / bulk
            )  # in compliance, since a void in a nearly incompressible matrix is a stiff equation
            soft -= (
                step
                * (own_bulk * soft - 1.0)
                * (1.0 + 4.0 / 3.0 * shear * soft)
                / (own_bulk + 4.0 / 3.0 * shear)
            )
            shear = shear + step * (own_shear - shear) * (shear + around) / (own_shear + around)
            bulk = 1.0 / soft
    return 9.0 * bulk * shear / (3.0 * bulk + shear)


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


def campaign(recipe: Recipe, changes: wrong_inputs.Changes, draws: int) -> pd.DataFrame:
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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recipe", type=Path, default=Path("data/forecast/recipe.yaml"))
    parser.add_argument("--packings", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True, help="table of rates")
    parser.add_argument("--draws", type=int, default=50)
    asked = parser.parse_args()
    stated = read_recipe(asked.recipe)
    rates = campaign(stated, wrong_inputs.changes_of(stated, Networks(kept_in(asked.packings))), asked.draws)
    asked.output.parent.mkdir(parents=True, exist_ok=True)
    rates.to_csv(asked.output, index=False)
    print(rates.to_string(index=False))
