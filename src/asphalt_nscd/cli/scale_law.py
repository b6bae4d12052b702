from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("law", type=_options.File)
@click.option("--parameter", required=True, help="Parameter to change: Em, eta_m, Ek or eta_k.")
@click.option("--factor", required=True, type=_options.POSITIVE, help="Factor on the parameter.")
@_options.output
def command(law: Path, parameter: str, factor: float, output: Path) -> None:
    """Change one parameter of a Burgers law, for the sensitivity study."""
    from asphalt_nscd.rheology.scaled_laws import scale_law

    scale_law(law, parameter, factor, output)
