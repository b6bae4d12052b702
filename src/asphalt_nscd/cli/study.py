from __future__ import annotations

import json
from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("study")
@_options.output
def command(study: str, output: Path) -> None:
    """Write STUDY, the complete configuration in JSON, to a file."""
    from asphalt_nscd.files.errors import InputError
    from asphalt_nscd.files.store import write_json

    try:
        content = json.loads(study)
    except json.JSONDecodeError as error:
        raise InputError(f"STUDY is not valid JSON ({error}); give the configuration as JSON.") from None
    write_json(output, content)
