from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import option, step


@step
def command(
    files: tuple[Path, ...],
    *,
    tolerance: float = option("Tolerance on both relative errors of the natural map.", 1e-8, above=0.0),
    output: Path | None = option("CSV table to write as well.", None),
) -> None:
    """Solve frictional contact problems in FCLIB's HDF5 format. The exit status is 1 if one did not converge.

    Prints a line for each problem: contacts, iterations, error, CPU seconds, and whether it converged. The
    error is that of Siconos and FCLIB; the scaled error does not depend on units. Iterations count
    Gauss-Seidel sweeps and steps of the interior path and of Newton's method.
    """
    from asphalt_nscd.contact_problems import fclib
    from asphalt_nscd.files import store

    outcomes = fclib.solve_files(files, tolerance)
    for outcome in outcomes:
        click.echo(outcome)
    if output is not None:
        store.write_table(output, fclib.table(outcomes))
    # Last, so that the table is written either way.
    unsolved = [outcome.file for outcome in outcomes if not outcome.converged]
    if unsolved:
        raise click.ClickException(f"not converged to {tolerance:g}: {', '.join(unsolved)}")
