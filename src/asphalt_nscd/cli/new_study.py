from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.table_import.quantities import MEASURED, SIEVES, spellings


@click.command(
    # A line of \b keeps click from filling the list below it into a paragraph.
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
@click.option("--sheet", help="The only sheet of an XLSX file to read; else all that hold tests.")
@_options.column
@click.option(
    "--geometry",
    type=_options.Geometry(_options.TRAPEZOID, _options.CYLINDER),
    help="Specimens, b_mm equal to B_mm for prisms. Needed for F0 and z0. With moduli the default is the paper's, with "
    "those of a direct test a cylinder of d_mm=100,h_mm=150.",
)
@_options.measured_in
@click.option("--grading", type=_options.File, help="Sieve table for the spheres: sieve (mm), passing (%).")
@click.option("--small", is_flag=True, help="One sample of some hundred spheres, to try a study in minutes.")
@_options.gather(
    "options",
    geometry="geometry",
    grading="grading",
    measured_in="measured_in",
    small="small",
    sheet="sheet",
    columns="columns",
)
def command(name: str, measurements: tuple[Path, ...], options: dict[str, Any]) -> None:
    """Write config/NAME.yaml, a study of your own measurements, and print how the table was read."""
    from asphalt_nscd.table_import.write import StudyOptions, new_study

    if isinstance(options["geometry"], str):
        options["geometry"] = Path(options["geometry"])
    options["columns"] = dict(options["columns"])
    config, notes = new_study(name, measurements, StudyOptions(**options))
    for note in notes:
        click.echo(note)
    click.echo(f"wrote {config}; run: snakemake --cores all --configfile {config}")
