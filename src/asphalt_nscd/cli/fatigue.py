from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options

_LAW = "bending.fatigue.FatigueLaw"


@click.command()
@click.argument("specimen", type=_options.File)
@click.option(
    "--strain",
    required=True,
    type=_options.Of(f"{_LAW}.endured"),  # a strain as well
    help="Largest amplitude of strain, as 100e-6.",
)
@click.option(
    "--endured",
    default=100e-6,
    type=_options.Of(f"{_LAW}.endured"),
    help="Amplitude of strain that uses a bond up in a million cycles.",
)
@click.option(
    "--exponent",
    default=5.0,
    type=_options.Of(f"{_LAW}.exponent"),
    help="By which its life falls with strain.",
)
@click.option(
    "--every-cycle",
    default=None,
    type=_options.File,
    help="Law of the bonds, JSON: step through every cycle with it, instead of jumps. For a few dozen cycles.",
)
@click.option(
    "--finer",
    default=1.0,
    type=_options.Number(low=0.1, high=1e4),
    help="How many times shorter jumps are than usual.",
)
@click.option("--frequency-hz", default=25.0, type=_options.POSITIVE, help="Frequency, with --every-cycle.")
@click.option("--profile", default=None, type=_options.File, help="File for the damage over the height.")
@_options.output
@_options.gather("fatigue_law", endured="endured", exponent="exponent")
@_options.gather("stepped", law="every_cycle", frequency="frequency_hz")
def command(
    specimen: Path,
    strain: float,
    fatigue_law: dict[str, Any],
    stepped: dict[str, Any],
    finer: float,
    profile: Path | None,
    output: Path,
) -> None:
    """Tire a trapezoid at constant strain until half of its stiffness is left, as EN 12697-24 does."""
    from asphalt_nscd.bending.bending_test import bond_law
    from asphalt_nscd.bending.fatigue import FatigueLaw, cycle_by_cycle, fatigue, profile_of, table_of
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.nscd.bonds.fatigue import Jumps
    from asphalt_nscd.rheology.laws_io import read_bond_law
    from asphalt_nscd.specimen.cutting import read_specimen

    given, law = read_specimen(specimen), FatigueLaw(**fatigue_law)
    if stepped["law"] is None:
        course = fatigue(given, strain, law, jumps=Jumps().finer(finer))
    else:
        course = cycle_by_cycle(
            given, strain, law, bond_law(read_bond_law(stepped["law"])), stepped["frequency"]
        )
    write_table(output, table_of(course))
    if profile is not None:
        write_table(profile, profile_of(given, course))
    click.echo(f"{output}: half of the stiffness is left after {course.life():.3g} cycles")
