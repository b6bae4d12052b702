from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars


@click.command()
@click.argument("recipe", type=_options.File)
@click.option("--seeds", default=2, type=click.IntRange(1, 20), help="Packings of each level.")
@click.option(
    "--other-cuts", is_flag=True, help="Pour what `forecast-mixes` needs too: other cuts of the grading."
)
@click.option("--output", required=True, type=_options.File, help="Folder of packings to fill.")
def command(recipe: Path, seeds: int, other_cuts: bool, output: Path) -> None:
    """Pour the packings of a recipe's levels, so that forecasts find them; those that are there are kept."""
    from asphalt_nscd.forecasting.forecast import kept_in
    from asphalt_nscd.forecasting.levels import CUTS, OTHER_CUTS, levels_of
    from asphalt_nscd.forecasting.recipe import read_recipe

    with bars("s") as progress:
        packing = kept_in(output, progress)
        asked = read_recipe(recipe)
        wanted = [(level, seed) for level in levels_of(asked, CUTS) for seed in range(1, seeds + 1)]
        if other_cuts:
            wanted += [(level, 1) for cuts in OTHER_CUTS.values() for level in levels_of(asked, cuts)]
        for level, seed in wanted:
            poured = packing(level, seed)
            click.echo(
                f"{level.name}, seed {seed}: {poured.radius.size} spheres, solid fraction "
                f"{poured.solid_fraction:.3f}, {poured.coordination:.2f} contacts of each"
            )
