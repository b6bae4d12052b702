from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.further_settings import STRAINS, FatigueLaw
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    specimen: Path,
    *,
    strain: float = option("Largest amplitude of strain, as 100e-6.", range=STRAINS),
    fatigue_law: FatigueLaw,
    every_cycle: Path | None = option(
        "Law of the bonds, JSON: step through every cycle with it, instead of jumps. For a few dozen cycles.",
        None,
    ),
    finer: float = option("How many times shorter jumps are than usual.", 1.0, low=0.1, high=1e4),
    frequency_Hz: float = option("Frequency, with --every-cycle.", 25.0, above=0.0),
    profile: Path | None = option("File for the damage over the height.", None),
    output: Path = OUTPUT,
) -> None:
    """Tire a trapezoid at constant strain until half of its stiffness is left, as EN 12697-24 does."""
    from asphalt_nscd.bending.bending_test import bond_law
    from asphalt_nscd.bending.fatigue import cycle_by_cycle, fatigue, profile_of, table_of
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.nscd.bonds.fatigue import Jumps
    from asphalt_nscd.rheology.laws_io import read_bond_law
    from asphalt_nscd.specimen.cutting import read_specimen

    given = read_specimen(specimen)
    if every_cycle is None:
        course = fatigue(given, strain, fatigue_law, jumps=Jumps().finer(finer))
    else:
        course = cycle_by_cycle(
            given, strain, fatigue_law, bond_law(read_bond_law(every_cycle)), frequency_Hz
        )
    write_table(output, table_of(course))
    if profile is not None:
        write_table(profile, profile_of(given, course))
    click.echo(f"{output}: half of the stiffness is left after {course.life():.3g} cycles")
