from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _data, _options


class Part(click.ParamType):
    """`0 Diagnosis=results/paper/figures/fig_master.png` as (part, path)."""

    name = "part=path"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        """A part of a page and a path of `part=path`."""
        part, equals, path = value.partition("=")
        if not equals or not part or not path:
            self.fail(f"{value!r} is not of the form part=path.", param, context)
        return part, Path(path)


@click.command()
@click.argument("data", nargs=-1, type=_data.Data())
@click.option("--study", required=True, help="Name of the study.")
@click.option(
    "--entry",
    "entries",
    multiple=True,
    type=Part(),
    help="A figure (PNG) or page (HTML) and the part of the report that shows it; repeatable.",
)
@click.option(
    "--source",
    "sources",
    multiple=True,
    type=Part(),
    help="Name of a figure or page, and a file with its data that the report links; repeatable.",
)
@click.option(
    "--captions", required=True, type=_options.File, help="Folder of captions, an .rst file for each entry."
)
@_options.output
def command(
    data: tuple[tuple[str, Path], ...],
    study: str,
    entries: tuple[tuple[str, Path], ...],
    sources: tuple[tuple[str, Path], ...],
    captions: Path,
    output: Path,
) -> None:
    """Put all results of a study into one HTML file. Its first page is made from measured=CSV
    simulations=CSV samples=CSV diagnosis=JSON pictures=PNG.
    """
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.assemble import Entry, assemble
    from asphalt_nscd.reporting.pages.first_page import first_page

    page = _data.made_from(data, first_page)
    shown = [
        Entry(part, path, [source for name, source in sources if name == path.stem]) for part, path in entries
    ]
    content = assemble(study, page, shown, captions, output.parent)
    with atomic_path(output) as path:
        path.write_text(content, encoding="utf-8")
