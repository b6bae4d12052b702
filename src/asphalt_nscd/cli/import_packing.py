from __future__ import annotations

import math
from pathlib import Path

import click

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    packing: Path,
    *,
    unit: str | None = option(
        "Of lengths, where the file does not say it; else m or mm, whichever makes aggregate of the radii.",
        None,
        choices=("m", "cm", "mm", "um"),
    ),
    up: str = option("Axis against gravity.", "z", choices=("x", "y", "z")),
    output: Path = OUTPUT,
) -> None:
    """Take spheres that another program poured as a deposit, from which `trim` cuts a specimen.

    PACKING: CSV with x, y, z, radius; text of YADE; dump of LIGGGHTS or LAMMPS; VTK with an array radius.
    """
    from asphalt_nscd.api.specimens import read_packing

    if output.suffix.lower() != ".h5":
        raise click.UsageError(f"{output}: a deposit is a file of HDF5; let its name end in .h5.")
    given = read_packing(packing, unit=unit, up=up)
    given.write(output)
    height = math.floor(1e5 * given.box_m[0]) / 100.0  # mm; a beam longer than the box is refused
    click.echo("\n".join(given.notes))
    click.echo(
        f"wrote {output}; cut a specimen as high as the box is long: asphalt-nscd trim {output} --geometry "
        f"h_mm={height:g},..."
    )
