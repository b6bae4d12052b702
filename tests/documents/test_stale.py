"""Published tables name a commit of this history and the sources they rest on; those that are old are listed."""

from __future__ import annotations

import io
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.reporting import publish
from asphalt_nscd.reporting.publish import RESTS_ON, Sources, stale

ROOT = Path(__file__).parents[2]
TOOL = runpy.run_path(str(ROOT / "tools/stale.py"))


@pytest.fixture(autouse=True)
def root(monkeypatch):
    monkeypatch.chdir(ROOT)


def test_what_is_stale_is_listed_and_nothing_else():
    """Red? Publish anew by the command beside it, or say that it is old: python tools/stale.py --write"""
    kept = io.StringIO(TOOL["LEDGER"].read_text())
    assert TOOL["table"]().to_csv(index=False) == pd.read_csv(kept).to_csv(index=False)


def test_commits_are_of_this_history():
    if not shutil.which("git") or not (ROOT / ".git").exists():
        pytest.skip("no git repository")
    listed = set(TOOL["table"]()["published"])
    for path in Path("results/published").glob(f"*/{RESTS_ON}"):
        for name, entry in read_json(path).items():
            assert name in listed or not set(entry["commits"]) & set(TOOL["strangers"]()), name


def test_a_change_of_meaning_makes_a_table_stale_and_a_comment_does_not(tmp_path):
    (table := tmp_path / "results/one/a.csv").parent.mkdir(parents=True)
    table.write_text("a\n1\n")
    read = tmp_path / "b.csv"
    read.write_text("b\n2\n")
    rests_on = Sources(["rheology.burgers"], [str(read)])
    output = tmp_path / "published/one"
    publish.publish([table], table.parent, output, "publish_one", rests_on)
    assert stale(output.parent) == {}
    noted = read_json(output / RESTS_ON)
    assert noted["publish_one"]["files"] == ["a.csv"] and not publish.altered(output)
    read.write_text("b\n3\n")
    assert stale(output.parent) == {"publish_one": "its sources have changed"}
    noted["publish_one"]["digest"] = ""
    write_json(output / RESTS_ON, noted)
    assert stale(output.parent) == {"publish_one": "its sources were never noted"}


def test_what_rests_on_a_study_is_noted_as_the_command_notes_it():
    """The command that publishes knows no more than its folder."""
    told = "from asphalt_nscd.reporting.publish import Sources; print(Sources(['studies.forecast.blind'], []).digest())"
    said = subprocess.run(
        [sys.executable, "-c", told], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert len(said.strip()) == 64


def test_no_published_file_names_a_folder_of_the_machine_that_made_it():
    kept = [
        path
        for path in Path("results/published").rglob("*")
        if path.suffix in {".csv", ".json", ".md", ".txt"}
    ]
    assert kept
    own = re.compile(r"(?<![\w.:/<~])/(?:home|root|work|tmp|Users|mnt|opt|var|usr)/")
    assert {str(path): found.group() for path in kept if (found := own.search(path.read_text()))} == {}
