from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("files", nargs=-1, required=True, type=_options.File)
@click.option("--root", required=True, type=_options.File, help="Folder of the study, which holds the files.")
@click.option("--workflow", required=True, type=_options.File, help="Snakefile that made them.")
@click.option("--provenance", required=True, type=_options.File, help="The study's provenance.json.")
@_options.output
def command(files: tuple[Path, ...], root: Path, workflow: Path, provenance: Path, output: Path) -> None:
    """Put FILES of a study into one archive that says what they are and what made them (RO-Crate, .zip)."""
    from asphalt_nscd.reporting.crate import write_crate

    write_crate(files, root, workflow, provenance, output)
