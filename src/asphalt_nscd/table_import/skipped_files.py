"""Files of a folder that are passed over: each reason once, with how many files it is true of and up to three names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from asphalt_nscd.files.errors import InputError

MOST_NAMES = 3


@dataclass(frozen=True)
class SkippedFile:
    """A file or a sheet that is passed over, with the reason and how to mend that."""

    name: str
    reason: str
    mend: str = ""


def refused(name: str, error: InputError, path: Path) -> SkippedFile:
    """A file that `error` refused, with reason and mend; `path` is as the error names it."""
    said = str(error).removeprefix(f"{path}: ").removeprefix(f"{path}, ")
    reason, _, mend = said.partition("; ")
    # The names found differ between files; without them one reason is said once, for nine files of a folder.
    return SkippedFile(name, reason.partition(" (found:")[0], mend)


def listed(files: Sequence[SkippedFile]) -> str:
    """The files by reason: `a.csv, b.csv, c.csv and 9 more (the file is empty); d.pdf (neither CSV, ...)`."""
    by_reason: dict[str, list[str]] = {}
    for one in files:
        by_reason.setdefault(one.reason, []).append(one.name)
    parts = []
    for reason, names in by_reason.items():
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        parts.append(f"{', '.join(names[:MOST_NAMES])}{more} ({reason})")
    return "; ".join(parts)


def common_mend(files: Sequence[SkippedFile]) -> str:
    """What mends all files, if they have one reason; else empty."""
    return files[0].mend if len({one.reason for one in files}) == 1 else ""
