"""Paths as files name them: any text at all."""

from __future__ import annotations

import os
from pathlib import Path

from asphalt_nscd.files.errors import InputError

MOST_BYTES = 100_000_000  # of a text file that is read whole


def is_file(path: str | Path) -> bool:
    """Whether there is such a file; False too for text that cannot be the name of one."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):  # too long, or with a null character
        return False


def require_readable(path: str | Path, mend: str) -> None:
    """Refuse what is no file, or too large to be read whole; `mend` ends the message."""
    if not is_file(path):
        raise InputError(f"{path}: no such file; {mend}.")
    if Path(path).stat().st_size > MOST_BYTES:
        raise InputError(f"{path}: larger than {MOST_BYTES // 10**6} MB; give a smaller one.")


def require_writable(folder: str | Path) -> None:
    """Refuse a folder of results with a file in its place, or with a part into which nothing can be written.

    It need not exist yet; then the nearest folder above it is asked.
    """
    folder = Path(folder)
    standing = next(place for place in (folder, *folder.parents) if place.exists())
    if not standing.is_dir():
        raise InputError(f"{standing}: is a file, where the results should go; move it away.")
    for place in (standing, *(folder.rglob("*/") if standing == folder else ())):
        if not os.access(place, os.W_OK | os.X_OK):
            raise InputError(f"{place}: cannot be written to; make the folder and its file system writable.")


def inside(folder: Path, name: str) -> Path:
    """Path of a file in a folder, by any text as its name; refuses a name that leads out of the folder."""
    path = folder / name
    try:
        # Resolved, so that neither `..` nor a link leads out of the folder.
        if path.resolve().is_relative_to(folder.resolve()):
            return path
    except (OSError, ValueError):
        pass
    raise InputError(f"{name}: is outside {folder}; put the file into that folder.")
