from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("theme")
@_options.output
def command(theme: str, output: Path) -> None:
    """Verify the core on THEME and write a table: expected value, value found and verdict of each row."""
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.verification.study import verify

    write_table(output, verify(theme))
