from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("table", type=_options.File)
@click.option("--title", required=True, help="What the table shows.")
@_options.output
def command(table: Path, title: str, output: Path) -> None:
    """Show a CSV table as an HTML page."""
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.style import page

    content = page(table, title)
    with atomic_path(output) as path:
        path.write_text(content, encoding="utf-8")
