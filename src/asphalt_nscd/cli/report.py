from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import OUTPUT, Pair, option, step

PART = Pair("part=path")


@step
def command(
    data: _data.Pairs = _data.PAIRS,
    *,
    study: str = option("Name of the study."),
    entries: _data.Pairs = option(
        "A figure (PNG) or page (HTML) and the part of the report that shows it; repeatable.",
        (),
        key="entry",
        type=PART,
    ),
    sources: _data.Pairs = option(
        "Name of a figure or page, and a file with its data that the report links; repeatable.",
        (),
        key="source",
        type=PART,
    ),
    captions: tuple[Path, ...] = option(
        "The caption of each entry, NAME.rst; repeatable.", (), key="caption"
    ),
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
