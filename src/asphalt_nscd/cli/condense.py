from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    specimen: Path,
    *,
    bonds: Bonds,
    stand_by: int | None = option(
        "Bonds made ready to break; a test that breaks others takes seconds longer.  [default: 8; facets: 0]",
        None,
        low=0,
    ),
    excerpt_output: Path | None = option(
        "Small file to write for `simulate --excerpt`; most tests need no more.", None
    ),
    output: Path = OUTPUT,
) -> None:
    """Assemble the bonded system of a specimen and its reduced form. Every test on the specimen uses them."""
    from asphalt_nscd.bending.condensing import condense, idle_option_note

    unknowns, static, area = condense(specimen, bonds, output, excerpt_output, stand_by)
    if idle := idle_option_note(bonds, area):
        click.echo(f"warning: {idle}", err=True)
    click.echo(f"{output}: {unknowns} unknowns; static |E*| is {static:.4g} of the modulus of the bonds")
