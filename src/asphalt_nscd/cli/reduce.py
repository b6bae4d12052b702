from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("measurements", type=_options.File)
@_options.geometry
@_options.output
def command(measurements: Path, geometry: object, output: Path) -> None:
    """Reduce measured peaks, records or moduli to complex moduli, Eqs. (1)-(5)."""
    from asphalt_nscd.measurements import reduce_table

    reduce_table(measurements, geometry, output)
