from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars


@click.command()
@click.argument("recipe", type=_options.File)
@click.option(
    "--output", required=True, type=_options.File, help="Folder for forecast.csv, law.json and the page."
)
@click.option(
    "--packings", type=_options.File, help="Folder of packings to use and to fill; else OUTPUT/packings."
)
@click.option("--seeds", default=2, type=click.IntRange(1, 20), help="Packings of each level.")
@click.option("--page/--no-page", default=True, help="Whether to write forecast.html too.")
def command(recipe: Path, output: Path, packings: Path | None, seeds: int, page: bool) -> None:
    """Forecast |E*| and phase of a mix from its binder and recipe, with no measurement of the mix.

    RECIPE: YAML as data/forecast/recipe.yaml.
    """
    if page:  # before the work, since it needs the extra `figures`
        from asphalt_nscd.reporting.pages.forecast_page import write_page
    from asphalt_nscd.forecasting.forecast import Networks, forecast, kept_in
    from asphalt_nscd.forecasting.recipe import read_recipe
    from asphalt_nscd.forecasting.written import points, write

    asked = read_recipe(recipe)
    with bars("", on_terminal=True) as progress:
        found = forecast(
            asked,
            Networks(kept_in(packings or output / "packings", progress)),
            seeds=tuple(range(1, seeds + 1)),
            progress=progress,
        )
    names = write(found, output)
    if page:
        names.append(write_page(found, output).name)
    frame = points(found)
    click.echo(f"{asked.name}: forecast of {len(frame)} points, nothing fitted. {asked.caveat}".rstrip())
    if found.caution:
        click.echo(f"warning: {found.caution}", err=True)
    shown = (
        frame[[*frame.columns[:6]]].round(1).assign(frequency_Hz=frame["frequency_Hz"].map("{:.3g}".format))
    )
    click.echo(shown.to_string(index=False, max_rows=40))
    click.echo(f"\nWritten to {output}: {', '.join(names)}.")
