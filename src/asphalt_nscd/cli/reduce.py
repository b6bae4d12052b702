from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import CYCLES, GEOMETRY, OUTPUT, step


@step
def command(
    measurements: Path,
    *,
    geometry: Any = GEOMETRY,
    cycles: int | None = CYCLES,
    output: Path = OUTPUT,
) -> None:
    """Reduce measured peaks, records or moduli to complex moduli, Eqs. (1)-(5)."""
    from asphalt_nscd.measurements.reduction import reduce_table
    from asphalt_nscd.measurements.signs import negative_phases

    table = reduce_table(measurements, geometry, output, cycles=cycles)
    if note := negative_phases(table):
        click.echo(note, err=True)
