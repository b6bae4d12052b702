from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _data, _options


@click.command()
@click.argument("data", nargs=-1, type=_data.Data())
@click.option("--title", required=True, help="Title of the page.")
@_options.output
def command(data: tuple[tuple[str, Path], ...], title: str, output: Path) -> None:
    """Show a diagnosis as an HTML page, from diagnosis=JSON, residuals=CSV, causality=CSV.

    table4=CSV and ladder=CSV, of a study, may be added.
    """
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.diagnosis_page import render, sections

    content = render(_data.made_from(data, sections), title)
    with atomic_path(output) as path:
        path.write_text(content, encoding="utf-8")
