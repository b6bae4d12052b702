"""The commit that results name."""

from __future__ import annotations

import os
import subprocess

from asphalt_nscd.files import commit


def test_asking_for_the_commit_leaves_the_repository_alone(tmp_path, monkeypatch):
    """It may be asked for on a full disk, where a refreshed index would end as a lock."""
    monkeypatch.setattr(commit, "PACKAGE", tmp_path / "src/asphalt_nscd")
    assert commit.commit() == "unknown"
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b"]
    (tmp_path / "pyproject.toml").write_text("a")
    for arguments in (["init", "-q"], ["add", "."], ["commit", "-qm", "a"]):
        subprocess.run([*git, *arguments], check=True)
    os.utime(tmp_path / "pyproject.toml", (1.0, 1.0))
    index = (tmp_path / ".git/index").read_bytes()
    found = commit.commit()
    assert len(found) == 40 and (tmp_path / ".git/index").read_bytes() == index
    (tmp_path / "pyproject.toml").write_text("b")
    assert commit.commit() == f"{found}-dirty"
