from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli._options import (
    COLUMNS,
    CYLINDER,
    MEASURED_IN,
    ONLY_MIX,
    SHEET,
    TRAPEZOID,
    Geometry,
    option,
    step,
)
from asphalt_nscd.table_import.quantities import MEASURED, SIEVES, spellings


@step(
    # A line of \b keeps click from filling the list below it into a paragraph.
    epilog=f"""Names of columns, whatever their case, blanks and dashes, with the unit behind, as
in `|E*| [GPa]` or delta_rad:

\b
{spellings(MEASURED)}

Of a sieve table:

\b
{spellings(SIEVES)}"""
)
def command(
    name: str,
    *,
    measurements: tuple[Path, ...] = option(
        "Table (CSV, TSV, workbook), machine export, or a folder of them; repeatable."
    ),
    sheet: str | None = SHEET,
    only_mix: str | None = ONLY_MIX,
    columns: tuple[tuple[str, str], ...] = COLUMNS,
    geometry: Any = option(
        "Specimens, b_mm equal to B_mm for prisms. Needed for F0 and z0. With moduli the default is the paper's, with "
        "those of a direct test a cylinder of d_mm=100,h_mm=150.",
        None,
        type=Geometry(TRAPEZOID, CYLINDER),
    ),
    measured_in: str | None = MEASURED_IN,
    grading: Path | None = option("Sieve table for the spheres: sieve (mm), passing (%).", None),
    small: bool = option("One sample of some hundred spheres, to try a study in minutes.", False),
) -> None:
    """Write config/NAME.yaml, a study of your own measurements, and print how the table was read."""
    from asphalt_nscd.table_import.write import StudyOptions, new_study

    geometry = Path(geometry) if isinstance(geometry, str) else geometry
    options = StudyOptions(geometry, grading, measured_in, small, sheet, dict(columns), only_mix)
    config, notes = new_study(name, measurements, options)
    for note in notes:
        click.echo(note)
    click.echo(f"wrote {config}; run: snakemake --cores all --configfile {config}")
