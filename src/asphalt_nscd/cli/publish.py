from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import Pair, option, step


@step
def command(
    files: tuple[Path, ...],
    *,
    root: Path = option("Folder of the study, which holds the files."),
    output: Path = option("Folder to copy them to."),
    documents: tuple[Path, ...] = option(
        "Markdown file, or folder of them, whose blocks are filled; repeatable.", (), key="document"
    ),
    name: str = option("Under which it is noted what they rest on.", ""),
    modules: tuple[str, ...] = option("A module that they rest on; repeatable.", (), key="module"),
    sources: tuple[str, ...] = option("Another file that they rest on; repeatable.", (), key="source"),
    block: _data.Pairs = option("name=table for a block; repeatable.", (), type=Pair("kind=path")),
) -> None:
    """Copy results that will be committed, with checksums, and fill their tables into documents."""
    from asphalt_nscd.reporting.publish import Sources, fill_blocks, publish

    # Documents first: a block that is missing is refused before anything is copied.
    fill_blocks(documents, dict(block))
    publish(files, root, output, name, Sources(modules, sources) if name else None)
