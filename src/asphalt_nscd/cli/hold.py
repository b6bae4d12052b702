from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options

_HOLD = "bending.hold.Hold"


@click.command()
@click.argument("model", type=_options.File)
@click.option("--law", required=True, type=_options.File, help="Law of the bonds, JSON.")
@click.option(
    "--temperature-c",
    required=True,
    type=_options.Number(above=-273.15),
    help="Temperature of the law, degrees Celsius.",
)
@click.option("--force-n", default=None, type=_options.Of(f"{_HOLD}.force_N"), help="Force held, N: creep.")
@click.option(
    "--displacement-m",
    default=None,
    type=_options.Of(f"{_HOLD}.displacement_m"),
    help="Displacement of the head held, m: relaxation. The default, at the amplitude of usual tests.",
)
@click.option("--duration-s", default=10.0, type=_options.Of(f"{_HOLD}.duration_s"), help="How long, s.")
@click.option(
    "--steps", default=1000, type=click.IntRange(10), help="Equal time steps; errors fall with their length."
)
@_options.gather(
    "held", force_N="force_n", displacement_m="displacement_m", duration_s="duration_s", steps="steps"
)
@_options.output
def command(model: Path, law: Path, temperature_c: float, held: dict[str, Any], output: Path) -> None:
    """Hold a force (creep) or a displacement (relaxation) on a specimen; a CSV with the law's closed form beside."""
    from asphalt_nscd.bending.hold import Hold, coarse, hold, told
    from asphalt_nscd.bending.model import read_model
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.rheology.laws_io import read_bond_law

    what = Hold(**held)
    table = hold(read_model(model), read_bond_law(law, temperature_c, what.band), what)
    write_table(output, table)
    click.echo(f"{output}: {told(table)}")
    if doubt := coarse(table):
        click.echo(f"warning: {doubt}", err=True)
