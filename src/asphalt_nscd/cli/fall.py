from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.bending.further_settings import Fall
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli._options import OUTPUT, offered, option, step


@step
def command(
    specimen: Path,
    *,
    law: Path = option("Law of the bonds, JSON."),
    how: Fall,
    bonds: Bonds = offered("yield_Pa", "friction"),
    output: Path = OUTPUT,
) -> None:
    """Let a specimen, whole or sawn in two, fall on a floor; `export --format vtk` films it.

    The floor has the friction of the spheres.
    """
    from asphalt_nscd.bending.bending_test import bond_law
    from asphalt_nscd.bending.fall import fell
    from asphalt_nscd.files.store import save
    from asphalt_nscd.files.words import counted
    from asphalt_nscd.rheology.laws_io import read_bond_law
    from asphalt_nscd.specimen.cutting import read_specimen

    arrays, columns = fell(read_specimen(specimen), bond_law(read_bond_law(law)), how, bonds)
    save(output, "fall", arrays, columns)
    click.echo(
        f"{output}: {counted(columns['fragments'], 'piece')}, the fastest sphere moves at {columns['speed_m_s']:.2g} "
        f"m/s; of {columns['energy_J']:.3g} J the account misses {columns['error_percent']:.1g} %"
    )
