from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    study: Path | None = option("", None),
    *,
    folder: Path | None = option(
        "Folder of results, of which each part is named with the commits that made it.", None
    ),
    output: Path = OUTPUT,
) -> None:
    """Record what made the results: the commit, package versions and, if given, STUDY."""
    from asphalt_nscd.files.store import made_by, provenance, read_json, write_json

    parts = {} if folder is None else {"made_by": made_by(folder)}
    write_json(output, provenance() | parts | ({} if study is None else {"study": read_json(study)}))
