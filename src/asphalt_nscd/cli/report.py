from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import OUTPUT, step
from asphalt_nscd.files.options import option


class Part(click.ParamType):
    """`0 Diagnosis=results/paper/figures/fig_master.png` as (part, path)."""

    name = "part=path"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        """A part of a page and a path of `part=path`."""
        part, equals, path = value.partition("=")
        if not equals or not part or not path:
            self.fail(f"{value!r} is not of the form part=path.", param, context)
        return part, Path(path)


@step
def command(
    data: _data.Pairs = _data.PAIRS,
    *,
    study: str = option("Name of the study."),
    entries: _data.Pairs = option(
        "A figure (PNG) or page (HTML) and the part of the report that shows it; repeatable.",
        (),
        key="entry",
        type=Part(),
    ),
    sources: _data.Pairs = option(
        "Name of a figure or page, and a file with its data that the report links; repeatable.",
        (),
        key="source",
        type=Part(),
    ),
    captions: Path = option("Folder of captions, an .rst file for each entry."),
    output: Path = OUTPUT,
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
