from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _progress
from asphalt_nscd.cli._options import OUTPUT, option, step
from asphalt_nscd.specimen.settings import Pouring


@step
def command(
    *,
    counts: Path = option(
        "Table diameter_mm,count; or a deposit, .h5, to go on from where its spheres stand."
    ),
    pouring: Pouring,
    output: Path = OUTPUT,
) -> None:
    """Pour spheres from a random lattice by gravity, then vibrate the layer with the top wall."""
    from asphalt_nscd.nscd.core_cache import is_compiled
    from asphalt_nscd.specimen.preparation import deposit, unrest

    # Half a minute without a word looks like a hang.
    if not is_compiled("granular.step"):
        click.echo("compiling the core, once for this version: half a minute", err=True)
    with _progress.bars("s") as progress:
        attributes = deposit(counts, pouring, output, progress)
    if doubt := unrest(attributes):
        click.echo(f"warning: {doubt}", err=True)
