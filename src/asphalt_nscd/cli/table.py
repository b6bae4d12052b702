from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import OUTPUT, step


@step
def command(name: str, data: _data.Pairs = _data.PAIRS, *, output: Path = OUTPUT) -> None:
    """Make table NAME from DATA, each kind=path."""
    from asphalt_nscd.files.store import write_table

    make = _data.part("reporting.tables", name).make
    write_table(output, _data.made_from(data, make))
