from __future__ import annotations

import os

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import require_writable


def test_folder_that_stands_or_will_be_made_is_taken(tmp_path):
    (tmp_path / "results/a/b").mkdir(parents=True)
    require_writable(tmp_path / "results/a")
    require_writable(tmp_path / "results/c/d")
    require_writable("nowhere/at/all")


def test_part_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    """Root may write anywhere but on a file system that is read-only."""
    (part := tmp_path / "results/deposits").mkdir(parents=True)
    monkeypatch.setattr(os, "access", lambda path, mode: path != part)
    with pytest.raises(InputError, match="results/deposits: "):
        require_writable(tmp_path / "results")
