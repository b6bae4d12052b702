"""Digests of what a workflow makes, each in a hidden file beside it: a bit may turn, or lines be lost.

HDF5 files hold their own (`store`).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from asphalt_nscd.errors import DamagedFile, is_result
from asphalt_nscd.paths import is_file

WHOLE = 64  # characters of a digest that was written to its end


def keep(path: Path, content: Path) -> None:
    """Write down the digest of `content`, which is about to become the result `path`; of other files none."""
    beside = _beside(path)
    standing = beside.exists()  # a step of the workflow repeated by hand
    if standing or (is_result(path) and path.suffix != ".h5"):
        beside.unlink(missing_ok=True)  # it may be another user's
        beside.write_text(_digest(content) + "\n")


def require_unchanged(arguments: Iterable[str]) -> None:
    """Refuse a result among the arguments of a step, `path` or `kind=path`, that is not what was written."""
    for argument in arguments:
        path = Path(argument.rpartition("=")[2])
        if is_result(path) and is_file(path) and is_file(_beside(path)):
            kept = _beside(path).read_bytes().strip()
            if len(kept) == WHOLE and kept != _digest(path).encode():
                raise DamagedFile(
                    path,
                    "content is not what was written: damaged, or changed by hand (to have that taken, put it back "
                    f"and delete {_beside(path).name})",
                )


def _beside(path: Path) -> Path:
    return path.with_name(f".{path.name}.sha256")


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
