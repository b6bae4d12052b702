"""Result files small enough to check a figure by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from tiny_results import Results


@pytest.fixture
def results(tmp_path: Path) -> Results:
    return Results(tmp_path)
