from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(study: Path | None = option("", None), *, output: Path = OUTPUT) -> None:
    """Record what made the results: the commit, package versions and, if given, STUDY."""
    from asphalt_nscd.files.store import provenance, read_json, write_json

    write_json(output, provenance() | ({} if study is None else {"study": read_json(study)}))
