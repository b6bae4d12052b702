"""Of which commit this package is: what it was packed from, or the repository that it runs in."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
PACKED_FROM = "commit.txt"  # `git archive` fills it, and setup.py in sdist and wheel
TOLD = "ASPHALT_NSCD_COMMIT"  # by a workflow to its jobs, each of which would start git twice


def commit() -> str:
    """The hash, `-dirty` behind it where files were changed since; "unknown" if neither packed nor in a repository."""
    if told := os.environ.get(TOLD):
        return told
    packed = PACKAGE / PACKED_FROM
    named = packed.read_text(encoding="utf-8").strip() if packed.is_file() else ""
    if named and not named.startswith("$"):
        return named
    root = PACKAGE.parents[1]
    described = _git(root, "describe", "--always", "--abbrev=40")
    # What is untracked, as results beside the code, changes no code.
    changed = _git(root, "status", "--porcelain", "--untracked-files=no") if described else ""
    return (f"{described}-dirty" if changed else described) or "unknown"


def _git(root: Path, *arguments: str) -> str:
    """What git says of the repository at `root`, whoever owns it; nothing of a repository around `root`.

    It is only read: `describe --dirty` would refresh its index, and leave a lock on a full disk.
    """
    command = ["git", "--no-optional-locks", "-c", f"safe.directory={root}", "-C", str(root), *arguments]
    alone = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    alone["GIT_CEILING_DIRECTORIES"] = str(root.parent)
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False, env=alone).stdout.strip()
    except OSError:  # no git on this machine
        return ""
