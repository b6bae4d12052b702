"""Digests of what a workflow makes, each in a hidden file beside it, with the commit that made it.

A bit may turn, or lines be lost. HDF5 files hold their own (`store`).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from asphalt_nscd.files.commit import commit
from asphalt_nscd.files.errors import DamagedFile, is_result
from asphalt_nscd.files.paths import is_file

SUFFIX = ".sha256"
WHOLE = 64  # characters of a digest that was written to its end


def forget(path: Path) -> bool:
    """Remove the digest of a file that is about to be replaced, which may be another user's; whether there was one."""
    beside = _digest_file(path)
    standing = beside.exists()
    beside.unlink(missing_ok=True)
    return standing


def keep(path: Path, standing: bool) -> None:
    """Write down the digest of a result; of other files only where one stood, since a step was repeated by hand."""
    # HDF5 files hold their digest inside.
    if standing or (is_result(path) and path.suffix != ".h5"):
        _digest_file(path).write_text(f"{_digest(path)} {commit()}\n")


def require_unchanged(arguments: Iterable[str]) -> None:
    """Refuse a result among the arguments of a step (`path` or `kind=path`) that differs from its digest."""
    for argument in arguments:
        path = Path(argument.rpartition("=")[2])
        if is_result(path) and is_file(path) and is_file(_digest_file(path)):
            kept = _digest_file(path).read_bytes().strip().partition(b" ")[0]
            if len(kept) == WHOLE and kept != _digest(path).encode():
                raise DamagedFile(
                    path,
                    "damaged, or edited after the workflow wrote it (to keep an edit, put the edited file back and "
                    f"delete {_digest_file(path).name})",
                )


def damaged(folder: str | Path) -> list[DamagedFile]:
    """One error for each damaged table, figure or page below a folder, which nothing else may ever read again."""
    found = []
    for beside in sorted(Path(folder).rglob(f".*{SUFFIX}")):
        try:
            with suppress(OSError):  # what cannot be read is for the step that needs it
                require_unchanged([str(beside.with_name(beside.name[1 : -len(SUFFIX)]))])
        except DamagedFile as error:
            found.append(error)
    return found


def makers(folder: str | Path) -> dict[Path, str]:
    """The commit that made each table, figure or page below a folder."""
    kept = {path.with_name(path.name[1 : -len(SUFFIX)]): path for path in Path(folder).rglob(f".*{SUFFIX}")}
    named = {
        path: beside.read_text().partition(" ")[2].strip() for path, beside in kept.items() if path.is_file()
    }
    return {path: by or "unknown" for path, by in named.items()}


def set_aside(error: DamagedFile) -> str:
    """Move a damaged file out of the way of the workflow, which would take it for sound; gives the sentence on it."""
    aside = error.path.with_name(f".{error.path.name}.damaged")
    with suppress(FileNotFoundError):  # another job has just done so
        error.path.replace(aside)
    return f"{error.path}: {error.problem}; it was set aside as {aside.name}, run the workflow again to make it anew."


def _digest_file(path: Path) -> Path:
    return path.with_name(f".{path.name}{SUFFIX}")


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
