from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import OUTPUT, step


@step
def command(tests: tuple[Path, ...], *, output: Path = OUTPUT) -> None:
    """Collect test files into one table, a row for each."""
    from asphalt_nscd.bending.collect import collect
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.files.words import counted

    write_table(output, collect(tests))
    click.echo(f"{output}: {counted(len(tests), 'test')}")
