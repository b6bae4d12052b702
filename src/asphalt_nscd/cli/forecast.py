from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import option, step
from asphalt_nscd.cli._progress import bars


@step
def command(
    recipe: Path,
    *,
    output: Path = option("Folder for forecast.csv, law.json and the page."),
    packings: Path | None = option("Folder of packings to use and to fill; else OUTPUT/packings.", None),
    seeds: int = option("Packings of each level.", 2, low=1, high=20),
    page: bool = option("Whether to write forecast.html too.", True),
) -> None:
    """Forecast |E*| and phase of a mix from its binder and recipe, with no measurement of the mix.

    RECIPE: YAML as data/forecast/recipe.yaml.
    """
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
        from asphalt_nscd.reporting.pages.forecast_page import write_page

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
