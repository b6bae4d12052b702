from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _data, _options


@click.command()
@click.argument("name")
@click.argument("data", nargs=-1, type=_data.Data())
@_options.output
def command(name: str, data: tuple[tuple[str, Path], ...], output: Path) -> None:
    """Make table NAME from DATA, each kind=path."""
    from asphalt_nscd.files.store import write_table

    make = _data.part("reporting.tables", name).make
    write_table(output, _data.made_from(data, make))
