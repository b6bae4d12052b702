from __future__ import annotations

import json
from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("study")
@_options.output
def command(study: str, output: Path) -> None:
    """Write down STUDY, the complete configuration as JSON."""
    from asphalt_nscd.store import write_json

    write_json(output, json.loads(study))
