from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.table_import.quantities import MEASURED, SIEVES, spellings


class Choice(click.ParamType):
    """`E_GPa=Steifigkeit`: what a column holds, in our names with its unit, and how the table calls it."""

    name = "quantity_unit=column"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        quantity, equals, column = value.partition("=")
        if not equals or not quantity.strip() or not column.strip():
            self.fail(f"{value!r} is not of the form E_GPa=column.", param, context)
        return quantity.strip(), column.strip()


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
    "--measurements", required=True, type=_options.File, help="CSV, TSV or XLSX, a row for each test."
)
@click.option("--sheet", help="Sheet of an XLSX file, where several hold something.")
@click.option(
    "--column",
    "columns",
    multiple=True,
    type=Choice(),
    help="What a column holds, where its name does not tell.",
)
@click.option(
    "--geometry",
    type=_options.Geometry(),
    help="Specimens, b=B for prisms; the paper's if left out with moduli.",
)
@click.option(
    "--measured-in",
    default="bending",
    type=click.Choice(["bending", "tension-compression"]),
    help="Test that gave the moduli.",
)
@click.option("--grading", type=_options.File, help="Sieve table for the spheres: sieve (mm), passing (%).")
@click.option("--small", is_flag=True, help="One sample of some hundred spheres, to try out in minutes.")
def command(
    name: str, measurements: Path, sheet: str | None, columns: tuple[tuple[str, str], ...], geometry: Any,
    measured_in: str, grading: Path | None, small: bool,
) -> None:  # fmt: skip
    """Write config/NAME.yaml, a study of your own measurements, and say what was understood of them."""
    from asphalt_nscd.table_import.write import Wishes, new_study

    given = Path(geometry) if isinstance(geometry, str) else geometry
    wishes = Wishes(given, grading, measured_in != "bending", small, sheet, dict(columns))
    config, notes = new_study(name, measurements, wishes)
    for note in notes:
        click.echo(note)
    click.echo(f"wrote {config}; run: snakemake --cores all --configfile {config}")
