from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("tests", nargs=-1, required=True, type=_options.File)
@_options.output
def command(tests: tuple[Path, ...], output: Path) -> None:
    """Collect test files into one table, a row for each."""
    from asphalt_nscd.bending.collect import collect
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.files.words import counted

    write_table(output, collect(tests))
    click.echo(f"{output}: {counted(len(tests), 'test')}")
