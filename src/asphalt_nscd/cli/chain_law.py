from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    spectrum: Path,
    *,
    temperature_C: float = option("Temperature of the test, degrees Celsius.", above=-273.15),
    lowest_Hz: float = option("Lowest frequency at which the chain must follow the law, Hz.", above=0.0),
    highest_Hz: float = option("Highest such frequency, Hz.", above=0.0),
    tolerance: float = option("Largest |ln(E_chain/E)| allowed between them.", 1e-3, above=0.0),
    factor: float = option("Factor on all moduli, which compensates that of the packing.", 1.0, above=0.0),
    output: Path = OUTPUT,
) -> None:
    """Convert a law of all temperatures to the Kelvin chain that bonds follow at one temperature."""
    from asphalt_nscd.rheology.chain_law import chain_law

    chain_law(spectrum, temperature_C, lowest_Hz, highest_Hz, tolerance, factor, output)
    click.echo(f"{output}: a Kelvin chain at {temperature_C:g} degC, from {lowest_Hz:g} to {highest_Hz:g} Hz")
