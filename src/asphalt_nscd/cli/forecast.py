from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import option, step


@step
def command(
    recipe: Path,
    *,
    output: Path = option("Folder for forecast.csv, law.json and the page."),
    packings: Path | None = option("Of older versions: nothing is poured any more.", None),
    page: bool = option("Whether to write forecast.html too.", True),
) -> None:
    """Forecast |E*| and phase of a mix from its binder and recipe, with no measurement of the mix.

    RECIPE: YAML as data/forecast/recipe.yaml.
    """
    del packings
    from asphalt_nscd.forecasting.forecast import forecast
    from asphalt_nscd.forecasting.recipe import read_recipe
    from asphalt_nscd.forecasting.written import points, rival_points, write

    asked = read_recipe(recipe)
    found = forecast(asked)
    names = write(found, output)
    if page:
        from asphalt_nscd.reporting.pages.forecast_page import write_page

        names.append(write_page(found, output).name)
    frame = points(found)
    click.echo(f"{asked.name}: forecast of {len(frame)} points. {asked.caveat}".rstrip())
    shown = frame[[*frame.columns[:6]]].round(1)
    shown["frequency_Hz"] = frame["frequency_Hz"].map("{:.3g}".format)
    for rival in ("hirsch", "witczak"):
        shown[f"{rival}_E_MPa"] = rival_points(found)[f"{rival}_E_MPa"].round(1)
    click.echo(shown.to_string(index=False, max_rows=60))
    click.echo(f"\nWritten to {output}: {', '.join(names)}.")
