"""Snakemake's locks: those that a killed one left behind go, those of a living one stay."""

from __future__ import annotations

import fcntl
from pathlib import Path
from typing import IO, Any

_alive: list[IO[str]] = []  # open files: the kernel drops their locks when this process ends, however it ends


def release_stale_locks(directory: str | Path) -> bool:
    """Remove the lock files in `directory`/locks if no other Snakemake lives; say whether it was so.

    Every Snakemake that reads the Snakefile holds a shared kernel lock on `directory`/alive until it
    ends. Whoever gets that lock exclusively is therefore alone, and Snakemake's own lock files, which
    survive SIGKILL and power loss, belong to nobody. Otherwise nothing is touched, and Snakemake
    itself refuses to write the same files twice at the same time.
    """
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    handle = (directory / "alive").open("a")
    _alive.append(handle)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        alone = False
    else:
        alone = True
        for stale in (directory / "locks").glob("*.lock"):
            stale.unlink(missing_ok=True)
    fcntl.flock(handle, fcntl.LOCK_SH)
    return alone


def remove_own_locks_only() -> None:
    """Have a Snakemake that ends leave the locks of others.

    As it stands (9.x) it removes the folder of all locks, after which a third one may write what a
    second one is writing.
    """
    from snakemake.persistence.file import FilePersistence

    def remove_own(persistence: Any) -> None:
        for lock in persistence._lockfile.values():
            Path(lock).unlink(missing_ok=True)
        persistence._lockfile.clear()

    FilePersistence._delete_locks = remove_own
