from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options

_CUTTING = "specimen.cutting.Cutting"


@click.command()
@click.argument("deposit", type=_options.File)
@_options.shape
@click.option(
    "--volume-reduction",
    default=0.1,
    type=_options.Of(f"{_CUTTING}.volume_reduction"),
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
    type=_options.Of(f"{_CUTTING}.gap_max_mm"),
    help="Pairs with a smaller gap are bonded, mm; with --area paper.",
)
@_options.output
@_options.gather("cutting", volume_reduction="volume_reduction", gap_max_mm="gap_max_mm", area="area")
def command(deposit: Path, geometry: Any, cutting: dict[str, Any], output: Path) -> None:
    """Cut the specimen from a deposit, turn it upright, shrink its spheres and bond them."""
    from asphalt_nscd.files.words import counted
    from asphalt_nscd.specimen.cutting import Cutting, trim_deposit

    said = trim_deposit(deposit, geometry, Cutting(**cutting), output)
    click.echo(
        f"{output}: {counted(int(said['spheres']), 'sphere')}, {counted(int(said['bonds']), 'bond')} by {said['area']}"
    )
