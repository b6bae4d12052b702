from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    files: tuple[Path, ...],
    *,
    root: Path = option("Folder of the study, which holds the files."),
    workflow: Path = option("Snakefile that made them."),
    provenance: Path = option("The study's provenance.json."),
    output: Path = OUTPUT,
) -> None:
    """Put FILES of a study into one archive that says what they are and what made them (RO-Crate, .zip)."""
    from asphalt_nscd.reporting.crate import write_crate

    write_crate(files, root, workflow, provenance, output)
