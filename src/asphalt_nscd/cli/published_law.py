from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    table: Path,
    *,
    temperature_C: float = option("Temperature to take, degrees Celsius.", above=-273.15),
    unit: str = option("Unit of the table's moduli.", choices=("kPa", "Pa")),
    output: Path = OUTPUT,
) -> None:
    """Take one Burgers law from a published table."""
    from asphalt_nscd.rheology.published_laws import published_law

    published_law(table, temperature_C, unit, output)
