from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options
from asphalt_nscd.cli._progress import bars
from asphalt_nscd.files.errors import InputError


@click.command()
@click.argument("recipe", type=_options.File)
@click.option("--measured", required=True, type=_options.File, help="Table of the mix that is doubted.")
@click.option(
    "--reference", required=True, type=_options.File, help="Table of a mix whose recipe is known to be right."
)
@click.option("--packings", required=True, type=_options.File, help="Folder of packings to use and to fill.")
@click.option(
    "--densities",
    nargs=2,
    type=click.FloatRange(500.0, 5000.0),
    help="Measured bulk and maximum density of the doubted mix, kg/m3.",
)
@_options.output
def command(
    recipe: Path,
    measured: Path,
    reference: Path,
    packings: Path,
    densities: tuple[float, float] | None,
    output: Path,
) -> None:
    """Name the wrong input of a recipe: air voids, binder content, stiffness of the binder, or dry contacts.

    RECIPE: YAML as data/forecast/recipe.yaml. Tables: temperature_C, frequency_Hz, E_MPa, phase_deg.
    """
    import numpy as np

    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.forecasting import wrong_inputs
    from asphalt_nscd.forecasting.forecast import Networks, kept_in
    from asphalt_nscd.forecasting.recipe import read_recipe

    if densities and densities[0] > densities[1]:
        raise InputError("--densities: the bulk density is above the maximum; give the bulk density first.")
    asked, ratio, known = wrong_inputs.read_ratio(measured, reference, read_recipe(recipe))
    with bars("", on_terminal=True) as progress:
        changes = wrong_inputs.changes_of(asked, Networks(kept_in(packings, progress)))
    weighed = np.log(np.array(densities) / wrong_inputs.densities(asked)) if densities else None
    finding = wrong_inputs.find(wrong_inputs.along_reference(changes, known), ratio, weighed)
    table = wrong_inputs.table(finding, wrong_inputs.limits(changes, weighed is not None))
    write_table(output, table)
    click.echo(f"Wrong: {' or '.join(finding.inputs) or 'no input that can be noticed'}.")
    click.echo(table.round(3).to_string(index=False))
