from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import OUTPUT, option, step
from asphalt_nscd.exports.formats import FORMATS
from asphalt_nscd.exports.settings import ExportSettings


@step
def command(
    source: Path,
    *,
    form: str = option(
        "Program that will read it; mepdg is AASHTOWare, xlsx Excel. vtk is for spheres and tests.",
        key="format",
        choices=[*FORMATS, "vtk"],
    ),
    temperatures_C: Sequence[float] | None = option(
        "Tested temperatures, degrees Celsius; else those of residuals.csv beside the law.",
        None,
        above=-273.15,
    ),
    frequencies_Hz: Sequence[float] | None = option(
        "Tested frequencies, Hz; else those of residuals.csv beside the law.", None, above=0.0
    ),
    settings: ExportSettings,
    output: Path = OUTPUT,
) -> None:
    """Write a law for another program: Prony series with shift, workbook, or table of |E*|.

    SOURCE: a law (JSON); or a deposit, specimen or test (HDF5), as vtk for ParaView or as csv.
    """
    from asphalt_nscd.api.exporting import export

    tested: dict[str, Any] = {"temperatures_C": temperatures_C, "frequencies_Hz": frequencies_Hz}
    click.echo(export(source, output, form, settings=settings, **tested))
