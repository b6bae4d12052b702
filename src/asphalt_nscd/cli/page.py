from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli._options import OUTPUTS, option, step


@step
def command(
    tables: tuple[Path, ...],
    *,
    titles: tuple[str, ...] = option("What a table shows, one for each.", key="title"),
    outputs: tuple[Path, ...] = OUTPUTS,
) -> None:
    """Show CSV tables as HTML pages."""
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.style import page

    if not len(tables) == len(titles) == len(outputs):
        raise click.UsageError("give each table a --title and an --output.")
    for table, title, output in zip(tables, titles, outputs, strict=True):
        content = page(table, title)
        with atomic_path(output) as path:
            path.write_text(content, encoding="utf-8")
