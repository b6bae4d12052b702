from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("packing", type=_options.File)
@click.option(
    "--unit", type=click.Choice(["m", "cm", "mm", "um"]),
    help="Of lengths, where the file does not say it; else m or mm, whichever makes aggregate of the radii.",
)  # fmt: skip
@click.option("--up", default="z", type=click.Choice(["x", "y", "z"]), help="Axis against gravity.")
@_options.output
def command(packing: Path, unit: str | None, up: str, output: Path) -> None:
    """Take spheres that another program poured as a deposit, from which `trim` cuts a specimen.

    PACKING: CSV with x, y, z, radius; text of YADE; dump of LIGGGHTS or LAMMPS; VTK with an array radius.
    """
    from asphalt_nscd.api.specimens import read_packing

    given = read_packing(packing, unit=unit, up=up)
    given.write(output)
    click.echo("\n".join([*given.notes, f"wrote {output}; cut a specimen: asphalt-nscd trim {output} ..."]))
