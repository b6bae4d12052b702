from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import option, step


@step
def command(
    recipe: Path,
    *,
    output: Path = option("Folder for forecast.csv, law.json and the page."),
    page: bool = option("Whether to write forecast.html too.", True),
) -> None:
    """Forecast |E*| and phase of a mix from its binder and recipe, with no measurement of the mix.

    RECIPE: a text file in YAML, as this one. Sieves are in mm or named (3/4, No. 4). For the binder's grade may stand
    {table: dsr.csv}, an export of a shear rheometer (text or workbook), {penetration_dmm: 60, softening_point_C: 50},
    or {A: 10.98, VTS: -3.68}.

    \b
      binder: {grade: PG 64-22}
      binder_percent_by_mass: 5.2
      air_voids_percent: 7
      grading: {19: 100, 9.5: 85, 4.75: 60, 2.36: 42, 0.6: 20, 0.15: 8, 0.075: 5}
    """  # noqa: D301 - click wants the backspace itself
    from asphalt_nscd.forecasting.forecast import forecast
    from asphalt_nscd.forecasting.recipe import read_recipe
    from asphalt_nscd.forecasting.written import answer, points, write
    from asphalt_nscd.table_import.shear import read_sweeps

    asked = read_recipe(recipe, read_sweeps)
    found = forecast(asked)
    names = write(found, output)
    if page:
        from asphalt_nscd.reporting.pages.forecast_page import write_page

        names.append(write_page(found, output).name)
    click.echo(f"{asked.name}\n")
    for sentence in answer(found):
        click.echo(click.wrap_text(sentence, 100) + "\n")
    for name, words in (("E_MPa", "|E*| (MPa)"), ("phase_deg", "phase (°)")):
        shown = points(found).pivot_table(name, "frequency_Hz", "temperature_C").sort_index(ascending=False)
        shown.index = shown.index.map("{:.3g} Hz".format).rename(None)
        shown.columns = shown.columns.map("{:g} °C".format).rename(None)
        click.echo(f"{words}\n{shown.round(1).to_string()}\n")
    click.echo(f"Written to {output}: {', '.join(names)}.")
