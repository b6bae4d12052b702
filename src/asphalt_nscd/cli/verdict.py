from __future__ import annotations

from pathlib import Path

import click

from asphalt_nscd.cli import _options


@click.command()
@click.argument("tables", nargs=-1, required=True, type=_options.File)
@click.option(
    "--output", default=None, type=_options.File, help="Write all rows here instead of judging them."
)
@click.option("--summary", is_flag=True, help="Write one row for each theme.")
def command(tables: tuple[Path, ...], output: Path | None, summary: bool) -> None:
    """Judge TABLES of the verification. If a row has failed, name it and exit with status 2."""
    from asphalt_nscd.files.store import write_table
    from asphalt_nscd.verification.study import joined, require_passed, summarised

    if output is None:
        require_passed(tables)
    else:
        rows = joined(tables)
        write_table(output, summarised(rows) if summary else rows)
