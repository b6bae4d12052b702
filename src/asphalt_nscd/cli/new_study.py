from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.table_import.quantities import MEASURED, SIEVES, spellings


@click.command(
    epilog=f"""Names of columns, whatever their case, blanks and dashes, with the unit behind, as
in `|E*| [GPa]` or delta_rad:

\b
{spellings(MEASURED)}

Of a sieve table:

\b
{spellings(SIEVES)}"""
)
@click.argument("name")
@click.option(
    "--measurements",
    required=True,
    multiple=True,
    type=_options.File,
    help="Table (CSV, TSV, XLSX), machine export, or a folder of them; repeatable.",
)
@click.option("--sheet", help="Sheet of an XLSX file, if several sheets hold data.")
@_options.column
@click.option(
    "--geometry",
    type=_options.Geometry(),
    help="Specimens, b_mm equal to B_mm for prisms. Needed for F0 and z0; with moduli the default is the paper's.",
)
@click.option(
    "--measured-in",
    type=click.Choice(["bending", "tension-compression"]),
    help="Test that gave the moduli; else tension-compression for machine exports, bending for tables.",
)
@click.option("--grading", type=_options.File, help="Sieve table for the spheres: sieve (mm), passing (%).")
@click.option("--small", is_flag=True, help="One sample of some hundred spheres, to try a study in minutes.")
def command(
    name: str, measurements: tuple[Path, ...], sheet: str | None, columns: tuple[tuple[str, str], ...], geometry: Any,
    measured_in: str | None, grading: Path | None, small: bool,
) -> None:  # fmt: skip
    """Write config/NAME.yaml, a study of your own measurements, and print how the table was read."""
    from asphalt_nscd.table_import.write import Wishes, new_study

    given = Path(geometry) if isinstance(geometry, str) else geometry
    wishes = Wishes(given, grading, measured_in, small, sheet, dict(columns))
    config, notes = new_study(name, measurements, wishes)
    for note in notes:
        click.echo(note)
    click.echo(f"wrote {config}; run: snakemake --cores all --configfile {config}")
