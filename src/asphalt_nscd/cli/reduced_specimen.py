from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("model", type=_options.File)
@_options.output
def command(model: Path, output: Path) -> None:
    """Extract from a condensed model the two small matrices that `diagnose --specimen` needs."""
    from asphalt_nscd.diagnosis.simulation.simulated import reduce_model

    reduce_model(model, output)
    click.echo(f"{output}: for diagnose --specimen {output}")
