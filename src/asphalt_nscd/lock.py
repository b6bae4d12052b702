"""Locks that a killed Snakemake left behind, told apart from those of a living one."""

from __future__ import annotations

import fcntl
from pathlib import Path
from typing import IO

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
