"""The list of files and rules of the paper names what is there."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd

ROOT = Path(__file__).parents[2]
OUTPUTS = ROOT / "data/paper/outputs.csv"


def test_every_rule_and_figure_named_is_one():
    rules = "".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
    named = " ".join(pd.read_csv(OUTPUTS).rules).split()
    known = set(
        re.findall(r"(?:rule | as |\")(\w+)", rules)
    )  # figures and tables are rules made of quoted names
    assert set(named) <= known, set(named) - known
    figures = {path.stem for path in (ROOT / "src/asphalt_nscd/reporting/figures").glob("fig[01]*.py")}
    assert figures <= set(named), figures - set(named)
