from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars


@click.command()
@click.argument("recipe", type=_options.File)
@click.option("--mixes", required=True, type=_options.File, help="Laws of binder and mix of each state.")
@click.option("--packings", required=True, type=_options.File, help="Folder of packings to use and to fill.")
@click.option(
    "--output",
    required=True,
    type=_options.File,
    help="Folder for errors.csv, overall.csv, points.csv and bands.csv.",
)
def command(recipe: Path, mixes: Path, packings: Path, output: Path) -> None:
    """Hold forecasts against mixes whose binder was measured too: what each part of the physics is worth."""
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.forecasting.forecast import Networks, kept_in
    from asphalt_nscd.forecasting.mixes import bands, compare, overall, read_pairs
    from asphalt_nscd.forecasting.recipe import read_recipe

    with bars("", on_terminal=True) as progress:
        networks = Networks(kept_in(packings, progress))
        pairs = read_pairs(mixes, read_recipe(recipe))
        errors, points = compare(pairs, networks, progress)
        held = bands(pairs, networks)
    for name, table in (
        ("errors", errors),
        ("points", points),
        ("overall", overall(errors)),
        ("bands", held),
    ):
        write_table(output / f"{name}.csv", table)
    click.echo(overall(errors).iloc[:, :4].round(2).to_string(index=False))
