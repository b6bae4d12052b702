"""Of which commit this package is: what the wheel was built from, or the repository that it runs in."""

from __future__ import annotations

import subprocess
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
BUILT_FROM = "commit.txt"  # in the wheel; setup.py writes it


def commit() -> str:
    """The hash, `-dirty` behind it where files were changed since; "unknown" outside of both."""
    built = PACKAGE / BUILT_FROM
    if built.is_file():
        return built.read_text(encoding="utf-8").strip()
    root = PACKAGE.parents[1]
    if PACKAGE.parent.name != "src" or not (root / "pyproject.toml").is_file():
        return "unknown"  # an environment may lie within another repository
    described = _git(root, "describe", "--always", "--abbrev=40")
    # What is untracked, as results beside the code, changes no code.
    changed = _git(root, "status", "--porcelain", "--untracked-files=no") if described else ""
    return (f"{described}-dirty" if changed else described) or "unknown"


def _git(root: Path, *arguments: str) -> str:
    """The repository is only read: `describe --dirty` would refresh its index, and leave a lock on a full disk."""
    command = ["git", "--no-optional-locks", "-C", str(root), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
