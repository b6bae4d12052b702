from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options

_BONDS = "bending.condensing.Bonds"


@click.command()
@click.argument("specimen", type=_options.File)
@click.option("--head", default="free", type=click.Choice(["free", "blocked"]), help="Rotation of the head.")
@click.option(
    "--poisson",
    default=0.35,
    type=_options.Of(f"{_BONDS}.poisson"),
    help="Ratio nu of Eqs. (8)-(11); for bonds by --area paper.",
)
@click.option(
    "--kt-over-kn",
    default=1.0,
    type=_options.Of(f"{_BONDS}.kt_over_kn"),
    help="Tangential over normal stiffness; for bonds by --area facets.",
)
@click.option(
    "--yield-pa",
    default=2.7e6,
    type=_options.Of(f"{_BONDS}.yield_Pa"),
    help="Yield stress of bonds between spheres, Pa.",
)
@click.option(
    "--friction",
    default=0.7,
    type=_options.Of(f"{_BONDS}.friction"),
    help="Coefficient of friction where a gap closes.",
)
@click.option(
    "--stand-by",
    default=None,
    type=click.IntRange(min=0),
    help="Bonds made ready to break; a test that breaks others takes seconds longer.  [default: 8; facets: 0]",
)
@click.option(
    "--excerpt-output",
    default=None,
    type=_options.File,
    help="Small file to write for `simulate --excerpt`; most tests need no more.",
)
@_options.output
@_options.gather(
    "bonds", head="head", poisson="poisson", kt_over_kn="kt_over_kn", yield_Pa="yield_pa", friction="friction"
)
def command(
    specimen: Path, bonds: dict[str, Any], stand_by: int | None, output: Path, excerpt_output: Path | None
) -> None:
    """Assemble the bonded system of a specimen and its reduced form. Every test on the specimen uses them."""
    from asphalt_nscd.bending.condensing import Bonds, condense, without_effect

    unknowns, static, area = condense(specimen, Bonds(**bonds), output, excerpt_output, stand_by)
    if idle := without_effect(Bonds(**bonds), area):
        click.echo(f"warning: {idle}", err=True)
    click.echo(f"{output}: {unknowns} unknowns; static |E*| is {static:.4g} of the modulus of the bonds")
