from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _data, _options


@click.command()
@click.argument("files", nargs=-1, required=True, type=_options.File)
@click.option("--root", required=True, type=_options.File, help="Folder of the study, which holds the files.")
@click.option("--output", required=True, type=_options.File, help="Folder to copy them to.")
@click.option(
    "--document",
    "documents",
    multiple=True,
    type=_options.File,
    help="Markdown file, or folder of them, whose blocks are filled; repeatable.",
)
@click.option("--block", multiple=True, type=_data.Data(), help="name=table for a block; repeatable.")
def command(
    files: tuple[Path, ...],
    root: Path,
    output: Path,
    documents: tuple[Path, ...],
    block: tuple[tuple[str, Path], ...],
) -> None:
    """Copy results that will be committed, with checksums, and fill their tables into documents."""
    from asphalt_nscd.reporting.publish import fill_blocks, publish

    # Documents first: a block that is missing is refused before anything is copied.
    fill_blocks(documents, dict(block))
    publish(files, root, output)
