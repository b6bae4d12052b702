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
    block: _data.Pairs = option("name=table for a block; repeatable.", (), type=Pair("kind=path")),
) -> None:
    """Copy results that will be committed, with checksums, and fill their tables into documents."""
    from asphalt_nscd.reporting.publish import fill_blocks, publish

    # Documents first: a block that is missing is refused before anything is copied.
    fill_blocks(documents, dict(block))
    publish(files, root, output)
