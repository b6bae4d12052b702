from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("deposit", type=_options.File)
@_options.geometry
@click.option(
    "--volume-reduction",
    default=0.1,
    type=_options.Number(low=0.0, below=1.0),
    help="Fraction of each sphere's volume that is removed.",
)
@click.option(
    "--area",
    default="paper",
    type=click.Choice(["paper", "facets"]),
    help="Area of a bond: pi rmin^2 of Eqs. (30)-(33), or the facet between the cells of two spheres.",
)
@click.option(
    "--gap-max-mm",
    default=2.0,
    type=_options.POSITIVE,
    help="Pairs with a smaller gap are bonded, mm; with --area paper.",
)
@_options.output
def command(
    deposit: Path, geometry: Any, volume_reduction: float, area: str, gap_max_mm: float, output: Path
) -> None:
    """Cut the specimen from a deposit, turn it upright, shrink its spheres and bond them."""
    from asphalt_nscd.files.words import counted
    from asphalt_nscd.specimen.preparation import trim_deposit

    said = trim_deposit(deposit, geometry, volume_reduction, gap_max_mm * 1e-3, output, area)
    click.echo(
        f"{output}: {counted(int(said['spheres']), 'sphere')}, {counted(int(said['bonds']), 'bond')} by {area}"
    )
