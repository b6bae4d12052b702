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
    run = subprocess.run(
        ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=40"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    return run.stdout.strip() or "unknown"
