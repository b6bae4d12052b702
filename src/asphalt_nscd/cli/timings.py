from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("benchmarks", nargs=-1, required=True, type=_options.File)
@click.option("--folder", required=True, type=_options.File, help="Folder whose names are those of rules.")
@click.option("--markdown", required=True, type=_options.File, help="File for the same table in Markdown.")
@_options.output
def command(benchmarks: tuple[Path, ...], folder: Path, markdown: Path, output: Path) -> None:
    """Sum Snakemake's BENCHMARKS files by rule, which shows where the time goes."""
    from asphalt_nscd.files.store import atomic_path, write_table
    from asphalt_nscd.reporting.timings import as_markdown, by_rule, elapsed

    table = by_rule(benchmarks, folder)
    write_table(output, table)
    with atomic_path(markdown) as path:
        path.write_text(as_markdown(table, elapsed(benchmarks)), encoding="utf-8")
