from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars


@click.command()
@click.argument("recipe", type=_options.File)
@click.option("--grading", required=True, type=_options.File, help="Table as data/paper/table1_grading.csv.")
@click.option("--laws", required=True, type=_options.File, help="Table as data/paper/table3_burgers.csv.")
@click.option("--packings", required=True, type=_options.File, help="Folder of packings to use and to fill.")
@_options.output
def command(recipe: Path, grading: Path, laws: Path, packings: Path, output: Path) -> None:
    """Forecast the paper's mix from its grading and the grade of its binder, beside its published laws."""
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.forecasting.forecast import Networks, kept_in
    from asphalt_nscd.forecasting.grade import compare_paper
    from asphalt_nscd.forecasting.recipe import read_recipe

    with bars("", on_terminal=True) as progress:
        networks = Networks(kept_in(packings, progress))
        found = compare_paper(grading, laws, read_recipe(recipe), networks, progress)
    write_table(output, found)
    click.echo(found.round(1).to_string(index=False))
