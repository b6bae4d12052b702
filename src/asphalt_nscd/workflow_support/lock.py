"""Snakemake's locks: those that a killed one left behind go, those of a living one stay.

After a kill Snakemake asks for --unlock; with --nolock two runs can write one folder.
"""

from __future__ import annotations

import fcntl
from pathlib import Path
from typing import IO

_alive: list[IO[str]] = []  # open files: the kernel drops their locks when this process ends, however it ends


def release_stale_locks(directory: str | Path) -> bool | None:
    """Remove the lock files in `directory`/locks where no other Snakemake lives; whether none does, None if unknown.

    Every Snakemake that reads the Snakefile holds a shared kernel lock on `directory`/alive until it ends. Whoever gets
    that lock exclusively knows that all others are gone, while Snakemake's own lock files survive SIGKILL and power
    loss, and wait for its option `--unlock`. Some file systems have no such locks. The directory is made if it is not
    there.
    """
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    handle = (directory / "alive").open("a")
    _alive.append(handle)
    try:
        alone = _is_free(handle)
        if alone:
            for path in (directory / "locks").glob("*.lock"):
                path.unlink(missing_ok=True)
        # Shared by all that live, which refuses the next one its exclusive lock.
        fcntl.flock(handle, fcntl.LOCK_SH)
    except OSError:  # as on Lustre without -o flock
        return None
    return alone


def _is_free(handle: IO[str]) -> bool:
    """Whether no other process holds the lock; this one then holds it."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
