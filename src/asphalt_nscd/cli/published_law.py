from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("table", type=_options.File)
@click.option(
    "--temperature-c",
    required=True,
    type=_options.Number(above=-273.15),
    help="Temperature to take, degrees Celsius.",
)
@click.option("--unit", required=True, type=click.Choice(["kPa", "Pa"]), help="Unit of the table's moduli.")
@_options.output
def command(table: Path, temperature_c: float, unit: str, output: Path) -> None:
    """Take one Burgers law from a published table."""
    from asphalt_nscd.rheology.published_laws import published_law

    published_law(table, temperature_c, unit, output)
