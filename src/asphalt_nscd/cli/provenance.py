from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("study", type=_options.File)
@_options.output
def command(study: Path, output: Path) -> None:
    """Write down what made the results: study, commit, versions."""
    from asphalt_nscd.store import provenance, read_json, write_json

    write_json(output, {**provenance(), "study": read_json(study)})
