from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.further_settings import Hold
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    model: Path,
    *,
    law: Path = option("Law of the bonds, JSON."),
    temperature_C: float = option("Temperature of the law, degrees Celsius.", above=-273.15),
    held: Hold,
    output: Path = OUTPUT,
) -> None:
    """Hold a force (creep) or a displacement (relaxation) on a specimen; a CSV with the law's closed form beside."""
    from asphalt_nscd.bending.hold import doubt, hold, told
    from asphalt_nscd.bending.model import read_model
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.rheology.laws_io import read_bond_law

    table = hold(read_model(model), read_bond_law(law, temperature_C, held.band), held)
    write_table(output, table)
    click.echo(f"{output}: {told(table)}")
    if words := doubt(table):
        click.echo(f"warning: {words}", err=True)
