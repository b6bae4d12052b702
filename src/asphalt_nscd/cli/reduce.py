from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("measurements", type=_options.File)
@_options.geometry
@click.option(
    "--cycles",
    type=click.IntRange(1),
    help="Number of whole cycles used, at the end of a record; else those of the last 10 s.",
)
@_options.output
def command(measurements: Path, geometry: Any, cycles: int | None, output: Path) -> None:
    """Reduce measured peaks, records or moduli to complex moduli, Eqs. (1)-(5)."""
    from asphalt_nscd.measurements.reduction import reduce_table

    reduce_table(measurements, geometry, output, cycles=cycles)
