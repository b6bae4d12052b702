"""Packings of a recipe's levels, those of other cuts of its grading included, poured so that forecasts find them."""

import sys
from pathlib import Path

from asphalt_nscd.forecasting.forecast import kept_in
from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.recipe import read_recipe

OTHER_CUTS = {  # m: what else might be done
    "stones from 1 mm": (0.063e-3, 1e-3),
    "stones from 4 mm": (0.063e-3, 4e-3),
    "two sands": (0.063e-3, 0.5e-3, 2e-3),
}
SEEDS = (1, 2)  # as `asphalt-nscd forecast` takes them; of other cuts the first alone


def pour(recipe: str | Path, folder: str | Path) -> None:
    """Fill the folder; packings that are there are kept."""
    packing, asked = kept_in(folder), read_recipe(recipe)
    wanted = [(level, seed) for level in levels_of(asked) for seed in SEEDS]
    wanted += [(level, SEEDS[0]) for cuts in OTHER_CUTS.values() for level in levels_of(asked, cuts)]
    for level, seed in wanted:
        poured = packing(level, seed)
        print(
            f"{level.name}, seed {seed}: {poured.radius.size} spheres, solid fraction {poured.solid_fraction:.3f}, "
            f"{poured.coordination:.2f} contacts of each"
        )


if __name__ == "__main__":
    sys.stdout = sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    pour(snakemake.input.recipe, snakemake.output[0])
