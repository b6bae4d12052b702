"""Scripts as rules run them: what they import, and how they end."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from asphalt_nscd.workflow_support import sources

ROOT = Path(__file__).parents[3]
BROKEN = """
from types import SimpleNamespace
from asphalt_nscd.cli import run_script
from studies.paper.scale_law import scale_law
job = SimpleNamespace(log=["log"], input=["law.json"])
run_script(job, lambda job: scale_law(job.input[0], "Em", 2.0, "scaled.json"))
"""
NAMED = """
from types import SimpleNamespace
import pandas as pd
from snakemake.iocontainers import InputFiles
from asphalt_nscd.cli import run_table
given = InputFiles(fromdict={"laws": "laws.csv", "code": "stamp"})
run_table(SimpleNamespace(log=["log"], input=given, output=["t.csv"]), lambda laws: pd.DataFrame({"laws": [laws]}))
"""


def test_the_code_behind_a_script_is_its_neighbours_and_what_they_import(monkeypatch):
    monkeypatch.setattr(sources, "STUDIES", [ROOT / "studies"])
    behind = sources.source_files("studies.paper.ensemble")
    assert ROOT / "studies/paper/smooth_bounds.py" in behind
    assert sources.PACKAGE / "rheology/burgers.py" in behind
    assert ROOT / "studies/paper/audit.py" not in behind


def test_all_scripts_are_fetched_where_there_is_no_clone():
    named = (ROOT / "workflow/rules/study.smk").read_text()
    for path in (ROOT / "studies/paper").glob("*.py"):
        assert f'"{path.stem}"' in named.split("OF_PAPER = [")[1].split("\n]\n")[0], path


def test_a_script_that_cannot_work_says_one_sentence_in_its_log(tmp_path):
    (tmp_path / "law.json").write_text('{"law": "2s2p1d"}')
    paths = os.pathsep.join([str(ROOT), str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-c", BROKEN]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, env=os.environ | {"PYTHONPATH": paths})
    assert done.returncode == 2 and done.stdout == done.stderr == b""
    said = (tmp_path / "log").read_text()
    assert said.startswith("error: law.json: key 'Em_Pa' is missing") and said.count("\n") == 1


def test_a_table_is_made_of_the_inputs_by_their_names(tmp_path):
    paths = os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-c", NAMED]
    done = subprocess.run(command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": paths})
    assert done.returncode == 0, (tmp_path / "log").read_text()
    assert (tmp_path / "t.csv").read_text() == "laws\nlaws.csv\n"
