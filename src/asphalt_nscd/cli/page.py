from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("tables", nargs=-1, required=True, type=_options.File)
@click.option("--title", "titles", multiple=True, required=True, help="What a table shows, one for each.")
@_options.outputs
def command(tables: tuple[Path, ...], titles: tuple[str, ...], outputs: tuple[Path, ...]) -> None:
    """Show CSV tables as HTML pages."""
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.style import page

    if not len(tables) == len(titles) == len(outputs):
        raise click.UsageError("give each table a --title and an --output.")
    for table, title, output in zip(tables, titles, outputs, strict=True):
        content = page(table, title)
        with atomic_path(output) as path:
            path.write_text(content, encoding="utf-8")
