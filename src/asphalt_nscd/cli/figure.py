from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _data, _options


@click.command()
@click.argument("name")
@click.argument("data", nargs=-1, type=_data.Data())
@click.option("--output-stem", required=True, type=_options.File, help="Path without .pdf, .png, .svg.")
def command(name: str, data: tuple[tuple[str, Path], ...], output_stem: Path) -> None:
    """Draw figure NAME from DATA, each kind=path, as PDF, PNG and SVG."""
    from asphalt_nscd.reporting.figures.save import save_figure

    draw = _data.part("reporting.figures", name).draw
    save_figure(_data.made_from(data, draw), output_stem)
