from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.exports.formats import FORMATS


@click.command()
@click.argument("source", type=_options.File)
@click.option(
    "--format",
    "form",
    required=True,
    help="Program that will read it; mepdg is AASHTOWare, xlsx Excel. vtk is for spheres and tests.",
    type=click.Choice([*FORMATS, "vtk"]),
)
@click.option(
    "--error-percent", default=1.0, type=_options.POSITIVE, help="Largest error of |E*| of the Prony series."
)
@click.option("--error-deg", default=0.5, type=_options.POSITIVE, help="Largest error of its phase, degrees.")
@click.option(
    "--temperatures-c",
    type=_options.Numbers(low=-273.15),
    help="Tested temperatures, degrees Celsius; else those of residuals.csv beside the law.",
)
@click.option(
    "--frequencies-hz",
    type=_options.Numbers(),
    help="Tested frequencies, Hz; else those of residuals.csv beside the law.",
)
@click.option(
    "--poisson", type=_options.Number(), help="Poisson's ratio; else 0.35, which the file calls assumed."
)
@click.option("--units", default="SI", type=click.Choice(["SI", "mm-N-MPa"]), help="Units of the file.")
@click.option("--name", default="ASPHALT", help="Name of the material (abaqus).")
@_options.output
@_options.gather(
    "settings",
    error_percent="error_percent",
    error_deg="error_deg",
    poisson="poisson",
    units="units",
    name="name",
)
@_options.gather("tested", temperatures_C="temperatures_c", frequencies_Hz="frequencies_hz")
def command(source: Path, form: str, settings: dict[str, Any], tested: dict[str, Any], output: Path) -> None:
    """Write a law for another program: Prony series with shift, workbook, or table of |E*|.

    SOURCE: a law (JSON); or a deposit, specimen or test (HDF5), as vtk for ParaView or as csv.
    """
    from asphalt_nscd.api.exporting import ExportSettings, export

    click.echo(export(source, output, form, settings=ExportSettings(**settings), **tested))
