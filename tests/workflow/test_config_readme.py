from __future__ import annotations

import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_config_readme_is_made_from_the_schema():
    page = runpy.run_path(str(ROOT / "tools/config_readme.py"))["page"]()
    assert (ROOT / "config/README.md").read_text() == page, "run python tools/config_readme.py"
