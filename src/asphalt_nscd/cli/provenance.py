from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("study", required=False, type=_options.File)
@_options.output
def command(study: Path | None, output: Path) -> None:
    """Record what made the results: the commit, package versions and, if given, STUDY."""
    from asphalt_nscd.files.store import provenance, read_json, write_json

    write_json(output, provenance() | ({} if study is None else {"study": read_json(study)}))
