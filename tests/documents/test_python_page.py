"""The examples of docs/python.md run as they stand, one after another."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_examples_of_the_page_run(tmp_path, monkeypatch):
    shutil.copytree(ROOT / "data/tutorial/exports", tmp_path / "data/tutorial/exports")
    shutil.copytree(ROOT / "data/forecast", tmp_path / "data/forecast")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(encoding="utf-8"), re.S)
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)
    assert names["diagnosis"].verdict == "explained" and (tmp_path / "mix.inp").is_file()
    assert 0.85 < names["test"].E_MPa / names["test"].attributes["E_law_MPa"] < 1.15
    assert names["solution"].reactions.round(5).tolist() == [0.01962, -0.004, 0.0]
