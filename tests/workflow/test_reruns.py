"""What runs again after a change, by dry runs over a study whose files are all there."""

from __future__ import annotations

import os
import re
import shutil

import pytest
import yaml
from workspace import ROOT, Plan, Workspace

pytestmark = pytest.mark.slow

TABLE = "data/paper/table3_burgers.csv"


class Finished(Workspace):
    """A study as if it had been run: files without content, and Snakemake's records of them."""

    @property
    def environment(self) -> dict[str, str]:
        return super().environment | {"PYTHONPATH": str(self.folder / "src")}

    def finish(self) -> None:
        shutil.copytree(ROOT / "src", self.folder / "src", ignore=shutil.ignore_patterns("__pycache__"))
        made = re.findall(r"^(results/\S+)\t", self.run("--summary").stdout, re.MULTILINE)
        assert made
        for name in made:
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        done = self.run("--touch", "--cores", "1")
        assert done.returncode == 0, done.stderr

    def edit(self, name: str, old: str, new: str) -> None:
        path = self.folder / name
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, 1))


def remade(plan: Plan) -> list[str]:
    """Files of the campaign that would be made again."""
    return re.findall(r"--output (results/paper/tests/\S+)", "\n".join(plan.lines))


@pytest.fixture(scope="module")
def paper(tmp_path_factory):
    study = Finished(tmp_path_factory.mktemp("paper"))
    content = yaml.safe_load((ROOT / "config/paper.yaml").read_text())
    (study.folder / "study.yaml").write_text(yaml.safe_dump(content))
    study.finish()
    return study


@pytest.fixture
def restored(paper):
    """The study, put back after the test; the stamps of what a plan found too, else the next plan finds it changed."""
    paths = [paper.folder / name for name in (TABLE, "src/asphalt_nscd/nscd/bonds/law.py")]
    paths += [path for folder in ("code", "rows") for path in paper.folder.glob(f".snakemake/{folder}/*")]
    kept = [(path, path.read_bytes(), path.stat()) for path in paths]
    yield paper
    for path, content, times in kept:
        path.write_bytes(content)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    for path in paper.folder.glob("results/**/*.gone"):
        path.rename(path.with_suffix(""))


def test_one_temperature_of_table_3_is_its_twenty_tests(restored):
    restored.edit(TABLE, "15,2.43e7", "15,2.44e7")
    plan = restored.plan()
    again, jobs = remade(plan), plan.jobs
    assert len(again) == 20 and all("/T15/" in path for path in again)
    # by way of the measurements, which are reconstructed from the whole table, and the diagnosis
    assert jobs["published_law"] == 1 and jobs["reconstruct"] == jobs["diagnose"] == jobs["fig09"] == 1
    assert not {"deposit", "trim", "condense", "simulate_scaled"} & set(jobs)
    assert restored.planned("results/paper/sensitivity.csv") == {}


def test_a_row_of_a_temperature_that_the_study_does_not_have_reruns_no_test(restored):
    path = restored.folder / TABLE
    path.write_text(path.read_text() + "40,1e7,1e6,1e7,1e5\n")
    assert restored.planned("results/paper/simulations.csv") == {}


def test_one_missing_result_is_one_test(restored):
    path = restored.folder / "results/paper/tests/s2/T0/f10.h5"
    path.rename(path.with_suffix(".h5.gone"))
    assert remade(restored.plan()) == ["results/paper/tests/s2/T0/f10.h5"]


def test_a_comment_reruns_nothing_and_another_sign_all_that_it_concerns(restored):
    law = "src/asphalt_nscd/nscd/bonds/law.py"
    restored.edit(law, '"""The bond law:', '"""The law of all bonds:')
    restored.edit(law, "import numpy as np\n", "import numpy as np  # arrays\n\n# of bonds\n")
    os.utime(restored.folder / law)
    assert restored.planned() == {}
    restored.edit(law, "self.spring_memory * sigma - ", "self.spring_memory * sigma + ")
    jobs = restored.planned()
    assert jobs["simulate"] == 120 and jobs["simulate_facets"] == jobs["simulate_extended"] == 24
    assert not {"deposit", "reconstruct", "fit"} & set(jobs)


def test_each_stage_is_a_target(restored):
    stages = ("laws", "deposits", "specimens", "tests", "tables", "figures", "diagnosis", "extended", "audit")
    for name in stages:
        assert f"`{name}`" in (ROOT / "docs/workflow.md").read_text()
    # Snakemake makes what is asked for by the name of its own rule
    assert restored.planned(*stages) in ({}, {"audit": 1, "tables": 1})
    jobs = restored.planned("deposits", "tests", "--forceall")
    assert (jobs["deposits"], jobs["deposit"], jobs["tests"], jobs["simulate"]) == (1, 4, 1, 120)
    assert not {"diagnose", "audit", "report"} & set(jobs)
