from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.further_settings import Ramp
from asphalt_nscd.cli import _progress
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    model: Path,
    *,
    law: Path = option("Law of the bonds, JSON."),
    temperature_C: float = option("Temperature of the law, degrees Celsius.", above=-273.15),
    pulled: Ramp,
    output: Path = OUTPUT,
) -> None:
    """Pull or push a specimen until it fails, and on; `export` writes the curve (csv) and a film (vtk)."""
    from asphalt_nscd.bending.model import read_model
    from asphalt_nscd.bending.ramp import RAMP, ramp, told
    from asphalt_nscd.files.store import save
    from asphalt_nscd.rheology.laws_io import read_bond_law

    followed = read_bond_law(law, temperature_C, pulled.band)
    with _progress.bars("steps") as report:
        arrays, columns = ramp(
            read_model(model), followed, pulled, lambda done, total: report("pulling", done, total)
        )
    save(output, RAMP, arrays, {**columns, "temperature_C": temperature_C})
    click.echo(f"{output}: {told(columns)}")
