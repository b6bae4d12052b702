from __future__ import annotations

import re
from pathlib import Path

import pandas as pd

from asphalt_nscd.reporting.tables.outputs import make

ROOT = Path(__file__).parents[3]
OUTPUTS = ROOT / "data/paper/outputs.csv"


def test_minutes_are_those_of_all_rules_of_a_part(tmp_path):
    outputs, timings = tmp_path / "outputs.csv", tmp_path / "timings.csv"
    outputs.write_text(
        "in_the_paper,rules,files\nTable 4,simulate table4,table4.csv\nFig. 1,fig01,a/ b.pdf\n"
    )
    timings.write_text("rule,wall_s\nsimulate,90\ntable4,30\nother,7\n")
    table = make([outputs], [timings])
    assert table["minutes"].tolist() == [2.0, 0.0]
    assert table["rules"].tolist() == ["`simulate`, `table4`", "`fig01`"]
    assert table["files"].tolist() == ["`table4.csv`", "`a/`, `b.pdf`"]


def test_every_rule_and_figure_named_is_one():
    rules = "".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
    named = " ".join(pd.read_csv(OUTPUTS).rules).split()
    known = set(
        re.findall(r"(?:rule | as |\")(\w+)", rules)
    )  # figures and tables are rules made of quoted names
    assert set(named) <= known, set(named) - known
    figures = {path.stem for path in (ROOT / "src/asphalt_nscd/reporting/figures").glob("fig[01]*.py")}
    assert figures <= set(named), figures - set(named)
