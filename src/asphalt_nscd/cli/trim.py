from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import BEAM, CYLINDER, OUTPUT, TRAPEZOID, Geometry, option, step
from asphalt_nscd.specimen.settings import Cutting


@step
def command(
    deposit: Path,
    *,
    geometry: Any = option(
        "Trapezoid in two-point bending; cylinder in tension-compression: d_mm,h_mm,mass_kg,mobile_mass_kg; prism in "
        "four-point bending: L_mm,H_mm,B_mm,mass_kg,mobile_mass_kg.",
        type=Geometry(TRAPEZOID, CYLINDER, BEAM),
    ),
    cutting: Cutting,
    output: Path = OUTPUT,
) -> None:
    """Cut the specimen from a deposit, turn it upright, shrink its spheres and bond them."""
    from asphalt_nscd.files.words import counted
    from asphalt_nscd.specimen.cutting import trim_deposit

    said = trim_deposit(deposit, geometry, cutting, output)
    click.echo(
        f"{output}: {counted(int(said['spheres']), 'sphere')}, {counted(int(said['bonds']), 'bond')} by {said['area']}"
    )
