"""Results dated in the future: the clock was set back since they were made, and dates tell nothing any more."""

from __future__ import annotations

import os
import time
from pathlib import Path

TOLERANCE = 60.0  # s, by which clocks of a file server and its clients may differ
LONG_AGO = 1e9  # s since 1970, older than any input


def mistrust_future(folder: str | Path) -> int:
    """Give files below `folder` that are dated in the future a date older than any input; returns how many.

    Snakemake takes a result that is newer than its inputs for up to date, so that an input edited since would go
    unnoticed. Of one older than its inputs it compares their content with what was used.
    """
    # Snakemake compares dates: what looks newer than its inputs would never be made again.
    latest = time.time() + TOLERANCE
    ahead = [path for path in Path(folder).rglob("*") if path.is_file() and path.stat().st_mtime > latest]
    for path in ahead:
        os.utime(path, (LONG_AGO, LONG_AGO))
    return len(ahead)
