from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars


@click.command()
@click.argument("recipe", type=_options.File)
@click.option(
    "--campaign", required=True, type=_options.File, help="Folder as data/ncat, with volumetrics.csv."
)
@click.option("--packings", required=True, type=_options.File, help="Folder of packings to use and to fill.")
@_options.output
def command(recipe: Path, campaign: Path, packings: Path, output: Path) -> None:
    """Hold what a percent of air costs in the forecast against specimens that differ in their air voids."""
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.forecasting.forecast import Networks, kept_in
    from asphalt_nscd.forecasting.recipe import read_recipe
    from asphalt_nscd.forecasting.void_slopes import compare_voids

    with bars("", on_terminal=True) as progress:
        found = compare_voids(campaign, read_recipe(recipe), Networks(kept_in(packings, progress)), progress)
    write_table(output, found)
    click.echo(found.round(1).to_string(index=False))
