"""What the benchmarks write apart from times: exponents of growth, and rows of peers that are absent."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from asphalt_nscd.store import write_table

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


def run(folder, script, *arguments, **environment):
    command = [sys.executable, str(BENCHMARKS / script), *map(str, arguments)]
    subprocess.run(command, cwd=folder, check=True, env=environment or None)


def test_exponents_are_those_of_the_powers(tmp_path):
    """cpu ~ n^1.5 and memory ~ n of one stage; a stage of one size has none."""
    rows = [
        {"topic": "growth", "case": "pour", "spheres": n, "cpu_s": 1e-4 * n**1.5, "memory_MB": 0.1 * n}
        for n in (1000, 4000, 16000)
    ]
    rows += [{"topic": "growth", "case": "cut", "spheres": 1000, "cpu_s": 1.0, "memory_MB": 2.0}]
    columns = ["topic", "case", "spheres", "time_step_s", "cpu_s", "memory_MB", "remark"]
    for k, row in enumerate([*rows, {"topic": "pouring", "case": "yade", "remark": "absent"}]):
        write_table(tmp_path / f"{k}.csv", pd.DataFrame([row], columns=columns))
    files = sorted(tmp_path.glob("*.csv"))
    run(tmp_path, "collect.py", *files, "--output", "table.csv", "--growth", "growth.csv")
    assert pd.read_csv(tmp_path / "table.csv").topic.tolist() == ["growth"] * 4 + ["pouring"]
    growth = pd.read_csv(tmp_path / "growth.csv").set_index("stage")
    assert growth.exponent_of_time["pour"] == pytest.approx(1.5)
    assert growth.exponent_of_memory["pour"] == pytest.approx(1.0)
    assert growth.loc["pour", "from"] == 1000 and growth.loc["pour", "to"] == 16000
    assert pd.isna(growth.exponent_of_time["cut"]) and growth.cpu_s_of_largest["cut"] == 1.0


@pytest.mark.parametrize(
    ("script", "arguments", "said"),
    [
        ("pouring.py", ["liggghts", "counts.csv"], "absent: no program liggghts"),
        ("pouring.py", ["yade", "counts.csv"], "absent: no program yade"),
        ("cycle.py", ["yade", "m.h5", "l.json", "--specimen", "s.h5"], "absent: no program yade"),
        ("fclib.py", [], "absent: no files given, make benchmark FCLIB=..."),
    ],
)
def test_what_is_absent_is_said(tmp_path, script, arguments, said):
    run(tmp_path, script, *arguments, "--output", tmp_path / "row.csv", PATH=str(tmp_path))
    row = pd.read_csv(tmp_path / "row.csv").iloc[0]
    assert row.remark == said and pd.isna(row.cpu_s) and pd.notna(row.topic)
