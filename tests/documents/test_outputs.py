"""The list of files and rules of the paper names what is there."""

from __future__ import annotations

import pandas as pd
from forks import forked
from workspace import ROOT

OUTPUTS = ROOT / "data/paper/outputs.csv"


def test_every_rule_and_figure_named_is_one():
    arguments = ["--list-rules", "--configfile", "config/paper.yaml", "--nolock"]
    listed = forked("snakemake.cli:main", arguments, ROOT)
    assert listed.returncode == 0, listed.stderr
    known = {line.split(" ")[0] for line in listed.stdout.splitlines()}
    named = " ".join(pd.read_csv(OUTPUTS).rules).split()
    assert set(named) <= known, set(named) - known
    figures = {path.stem for path in (ROOT / "src/asphalt_nscd/reporting/figures").glob("fig[01]*.py")}
    assert figures <= set(named), figures - set(named)
