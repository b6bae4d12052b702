from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options

_FALL, _BONDS = "bending.fall.Fall", "bending.condensing.Bonds"


@click.command()
@click.argument("specimen", type=_options.File)
@click.option("--law", required=True, type=_options.File, help="Law of the bonds, JSON.")
@click.option(
    "--height-mm", default=20.0, type=_options.Of(f"{_FALL}.height", unit=1e-3), help="Over the floor."
)
@click.option("--tilt-deg", default=75.0, type=_options.Of(f"{_FALL}.tilt"), help="Of its axis from upright.")
@click.option(
    "--sawn",
    default=0.5,
    type=_options.Of(f"{_FALL}.sawn"),
    help="Where it is sawn in two, as a share of its length from the foot; 0: nowhere.",
)
@click.option(
    "--duration-s", default=0.5, type=_options.Of(f"{_FALL}.duration"), help="How long it is followed."
)
@click.option("--time-step-s", default=2e-4, type=_options.Of(f"{_FALL}.time_step"), help="Time step.")
@click.option(
    "--yield-pa", default=2.7e6, type=_options.Of(f"{_BONDS}.yield_Pa"), help="Yield stress of bonds, Pa."
)
@click.option(
    "--friction", default=0.7, type=_options.Of(f"{_BONDS}.friction"), help="Of the floor and of spheres."
)
@click.option(
    "--frames", default=50, type=_options.Number(low=2, high=10_000), help="Instants to keep for ParaView."
)
@_options.output
@_options.gather("bonds", yield_Pa="yield_pa", friction="friction")
@_options.gather(
    "how",
    height="height_mm",
    tilt="tilt_deg",
    sawn="sawn",
    duration="duration_s",
    time_step="time_step_s",
    frames="frames",
)
def command(specimen: Path, law: Path, bonds: dict[str, Any], how: dict[str, Any], output: Path) -> None:
    """Let a specimen, whole or sawn in two, fall on a floor; `export --format vtk` films it."""
    from asphalt_nscd.bending.bending_test import bond_law
    from asphalt_nscd.bending.condensing import Bonds
    from asphalt_nscd.bending.fall import Fall, fell
    from asphalt_nscd.files.store import save
    from asphalt_nscd.files.words import counted
    from asphalt_nscd.rheology.laws_io import read_bond_law
    from asphalt_nscd.specimen.cutting import read_specimen

    # An option of type Number gives a float.
    how |= {"height": 1e-3 * how["height"], "frames": round(how["frames"])}
    arrays, columns = fell(read_specimen(specimen), bond_law(read_bond_law(law)), Fall(**how), Bonds(**bonds))
    save(output, "fall", arrays, columns)
    click.echo(
        f"{output}: {counted(columns['fragments'], 'piece')}, the fastest sphere moves at {columns['speed_m_s']:.2g} "
        f"m/s; of {columns['energy_J']:.3g} J the account misses {columns['error_percent']:.1g} %"
    )
