from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.further_settings import Cycling
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    model: Path,
    *,
    law: Path = option("Law of the bonds, JSON."),
    temperature_C: float = option("Temperature of the law, degrees Celsius.", above=-273.15),
    frequency_Hz: float = option("Of the force, Hz.", above=0.0),
    cycling: Cycling,
    output: Path = OUTPUT,
) -> None:
    """Load from rest a specimen whose grains touch, open and slip; its record as a CSV."""
    from asphalt_nscd.bending.cycles import cycle, told
    from asphalt_nscd.bending.model import read_model
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.rheology.laws_io import read_bond_law

    table = cycle(read_model(model), read_bond_law(law, temperature_C, [frequency_Hz]), frequency_Hz, cycling)
    write_table(output, table)
    click.echo(f"{output}: {told(table)}")
