from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("laws_table", type=_options.File)
@_options.geometry
@click.option("--seed", required=True, type=click.IntRange(0), help="Seed of the scatter.")
@click.option("--specimens", default=4, type=click.IntRange(1), help="Number of specimens to draw.")
@click.option(
    "--specimen-scatter",
    default=0.03,
    type=_options.NOT_NEGATIVE,
    help="Relative scatter of the modulus between specimens.",
)
@click.option(
    "--modulus-scatter",
    default=0.01,
    type=_options.NOT_NEGATIVE,
    help="Relative scatter of the modulus between tests.",
)
@click.option(
    "--phase-scatter-deg",
    default=0.3,
    type=_options.NOT_NEGATIVE,
    help="Scatter of the phase between tests, degrees.",
)
@click.option(
    "--amplitude-m", default=63e-6, type=_options.POSITIVE, help="Amplitude of the head's displacement, m."
)
@click.option(
    "--frequencies-hz", required=True, type=_options.Numbers(), help="Test frequencies, comma-separated, Hz."
)
@click.option("--law-output", type=_options.File, help="File for the law behind the table.")
@_options.output
@_options.gather(
    "sampling",
    seed="seed",
    specimens="specimens",
    frequencies="frequencies_hz",
    amplitude="amplitude_m",
    specimen_scatter="specimen_scatter",
    modulus_scatter="modulus_scatter",
    phase_scatter_deg="phase_scatter_deg",
)
def command(
    laws_table: Path, geometry: Any, output: Path, sampling: dict[str, Any], law_output: Path | None
) -> None:
    """Draw measurements about the smooth law behind a published table of Burgers laws."""
    from asphalt_nscd.rheology.reconstruct import Sampling, reconstruct_table

    reconstruct_table(laws_table, geometry, output, Sampling(**sampling), law_output)
