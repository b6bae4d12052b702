from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("measured", type=_options.File)
@click.option(
    "--temperature-c",
    required=True,
    type=_options.Number(above=-273.15),
    help="Temperature to fit, degrees Celsius.",
)
@_options.output
def command(measured: Path, temperature_c: float, output: Path) -> None:
    """Fit one Burgers law to the reduced measurements at one temperature, Eqs. (27)-(29)."""
    from asphalt_nscd.rheology.fitted_laws import fit_temperature

    fit_temperature(measured, temperature_c, output)
