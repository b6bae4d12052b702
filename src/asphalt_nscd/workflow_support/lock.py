"""Snakemake's locks: those that a killed one left behind go, those of a living one stay."""

from __future__ import annotations

import fcntl
import time
from collections.abc import Iterable
from pathlib import Path
from typing import IO, Any

YOUNG = 5.0  # s, in which whoever wrote a lock file has long come to hold it
_alive: list[IO[str]] = []  # open files: the kernel drops their locks when this process ends, however it ends


def release_stale_locks(directory: str | Path) -> bool:
    """Remove the lock files in `directory`/locks that belong to no living Snakemake; say whether no other lives.

    Every Snakemake that reads the Snakefile holds a shared kernel lock on `directory`/alive until it
    ends, and one on each lock file of its own (`hold_own_locks`). Whoever gets such a lock exclusively
    knows that its holder is gone, while Snakemake's own lock files survive SIGKILL and power loss.
    Of the living nothing is touched, and Snakemake itself refuses to write the same files twice at the
    same time.
    """
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    handle = (directory / "alive").open("a")
    _alive.append(handle)
    alone = _is_free(handle)
    for path in (directory / "locks").glob("*.lock"):
        if alone or _is_left_over(path):
            path.unlink(missing_ok=True)
    fcntl.flock(handle, fcntl.LOCK_SH)
    return alone


def hold_own_locks() -> None:
    """Have a Snakemake hold the lock files that it writes, and leave those of others where it ends.

    As it stands (9.x) it then removes the folder of all locks, after which a third one may write what a
    second one is writing.
    """
    from snakemake.persistence.file import FilePersistence

    write = FilePersistence._write_locks

    def write_and_hold(persistence: Any, lock_type: str, keys: Iterable[str]) -> None:
        write(persistence, lock_type, keys)
        if lock_type in persistence._lockfile:  # none where there are no keys
            handle = open(persistence._lockfile[lock_type])
            fcntl.flock(handle, fcntl.LOCK_SH)
            _alive.append(handle)

    def remove_own(persistence: Any) -> None:
        for lock in persistence._lockfile.values():
            Path(lock).unlink(missing_ok=True)
        persistence._lockfile.clear()

    FilePersistence._write_locks = write_and_hold
    FilePersistence._delete_locks = remove_own


def _is_free(handle: IO[str]) -> bool:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _is_left_over(path: Path) -> bool:
    """Whether the one that wrote a lock file is gone; one that was written just now may not be held yet."""
    try:
        with path.open() as handle:
            return time.time() - path.stat().st_mtime > YOUNG and _is_free(handle)
    except FileNotFoundError:  # its owner has just ended
        return False
