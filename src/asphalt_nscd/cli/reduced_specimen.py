from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import OUTPUT, step


@step
def command(model: Path, *, output: Path = OUTPUT) -> None:
    """Extract from a condensed model the two small matrices that `diagnose --specimen` needs."""
    from asphalt_nscd.diagnosis.simulation.simulated import reduce_model

    reduce_model(model, output)
    click.echo(f"{output}: for diagnose --specimen {output}")
