from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("spectrum", type=_options.File)
@click.option(
    "--temperature-c",
    required=True,
    type=_options.Number(above=-273.15),
    help="Temperature of the test, degrees Celsius.",
)
@click.option(
    "--lowest-hz",
    required=True,
    type=_options.POSITIVE,
    help="Lowest frequency at which the chain must follow the law, Hz.",
)
@click.option("--highest-hz", required=True, type=_options.POSITIVE, help="Highest such frequency, Hz.")
@click.option(
    "--tolerance", default=1e-3, type=_options.POSITIVE, help="Largest |ln(E_chain/E)| allowed between them."
)
@click.option(
    "--factor",
    default=1.0,
    type=_options.POSITIVE,
    help="Factor on all moduli, which compensates that of the packing.",
)
@_options.output
def command(
    spectrum: Path,
    temperature_c: float,
    lowest_hz: float,
    highest_hz: float,
    tolerance: float,
    factor: float,
    output: Path,
) -> None:
    """Convert a law of all temperatures to the Kelvin chain that bonds follow at one temperature."""
    from asphalt_nscd.rheology.chain_law import chain_law

    chain_law(spectrum, temperature_c, lowest_hz, highest_hz, tolerance, factor, output)
    click.echo(f"{output}: a Kelvin chain at {temperature_c:g} degC, from {lowest_hz:g} to {highest_hz:g} Hz")
