from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("benchmarks", type=_options.File)
@_options.output
def command(benchmarks: Path, output: Path) -> None:
    """Sum Snakemake's benchmark files by rule: where the time goes."""
    from asphalt_nscd.store import write_table
    from asphalt_nscd.timings import by_rule

    write_table(output, by_rule(benchmarks))
