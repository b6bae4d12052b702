"""Paths as files name them: any text at all."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.errors import InputError

MOST_BYTES = 100_000_000  # of a text file that is read whole


def is_file(path: str | Path) -> bool:
    """Whether there is such a file; False too for what cannot be the name of one."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):  # too long, or with a null character
        return False


def require_readable(path: str | Path, mend: str) -> None:
    """Refuse what is no file, or too large to be read whole."""
    if not is_file(path):
        raise InputError(f"{path}: no such file; {mend}.")
    if Path(path).stat().st_size > MOST_BYTES:
        raise InputError(f"{path}: larger than {MOST_BYTES // 10**6} MB; give a smaller one.")


def inside(folder: Path, name: str) -> Path:
    """The file `name` in a folder, refused where it leads out of it."""
    path = folder / name
    try:
        if path.resolve().is_relative_to(folder.resolve()):
            return path
    except (OSError, ValueError):
        pass
    raise InputError(f"{name}: leads out of {folder}; put the file into that folder.")
