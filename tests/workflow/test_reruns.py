"""Which change reruns exactly which jobs: dry runs on finished studies, of the paper and of a table of one's own."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml
from workspace import ROOT, Workspace

pytestmark = pytest.mark.slow

COSTS = "results/published/benchmark"  # which the audit reads
PARTS = (
    "Snakefile",
    "benchmarks",
    COSTS,
    "config",
    "data",
    "profiles",
    "src",
    "studies",
    "trials",
    "workflow",
)
COMPUTES = re.compile(
    "compile|deposit|import|trim|condense|simulate|fit$|.*_law$|reconstruct$|reduce|diagnose|name_|draw_|extend$"
)
DRAWN = "..."  # and the tables, figures and pages that follow


class Change(NamedTuple):
    """What is changed: `old` in a file becomes `new`; without `old` it is added at the end."""

    file: str
    old: str
    new: str


class Clone(Workspace):
    """A copy of the repository with a study as if it had been run: files without content, and Snakemake's records."""

    def __init__(self, folder: Path, study: dict) -> None:
        self.folder = folder
        for name in PARTS:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            ignored = {"ignore": shutil.ignore_patterns("__pycache__")} if (ROOT / name).is_dir() else {}
            copy(ROOT / name, folder / name, **ignored)
        rows = [
            f"A,{t},{f},{12000 - 250 * t + 100 * f},20"
            for t in (0, 10, 20, 30, 40)
            for f in (1, 3, 10, 25, 30)
        ]
        (folder / "mine.csv").write_text(
            "\n".join(["specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", *rows])
        )
        (folder / "study.yaml").write_text(yaml.safe_dump(study))
        made = re.findall(r"^(results/\S+)\t", self.run("--summary").stdout, re.MULTILINE)
        assert made
        for path in map(folder.joinpath, made):
            folder = path if path.name == "packings" else path.parent
            folder.mkdir(parents=True, exist_ok=True)
            path.touch()
        done = self.run("--touch", "--forceall", "--cores", "1")
        assert done.returncode == 0, done.stderr[-3000:]

    def command(self, *arguments: str) -> list[str]:
        return ["python", "-m", "snakemake", *arguments, "--configfile", "study.yaml"]

    def after(self, *changes: Change) -> dict[str, int]:
        """Jobs that changes rerun; these are then taken back, and so are the stamps that a plan writes."""
        stamps = {*self.folder.glob(".snakemake/*/*")}
        paths = stamps | {self.folder / change.file for change in changes}
        kept = [(path, path.read_bytes(), path.stat()) for path in paths if path.is_file()]
        try:
            for change in changes:
                path = self.folder / change.file
                text = path.read_text()
                assert change.old in text, change
                path.write_text(text.replace(change.old, change.new, 1) if change.old else text + change.new)
            return {rule: count for rule, count in self.planned().items() if rule != "all"}
        finally:
            for path in {*self.folder.glob(".snakemake/*/*")} - stamps:
                path.unlink()
            for path, content, times in kept:
                path.write_bytes(content)
                os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def meaning(module: str) -> Change:
    """A statement more in a module of the package."""
    return Change(f"src/asphalt_nscd/{module}.py", "", "\nMORE = 1\n")


def key(old: str, new: str) -> Change:
    return Change("study.yaml", old, new)


TABLE3 = "data/paper/table3_burgers.csv"
AFTER_DIAGNOSIS = "diagnose 1 name_causes 1 extend 2 simulate_extended 6 ..."
OWN_AFTER = "diagnose 1 name_causes 1 extend 1 simulate_extended 4 ..."
CAMPAIGN = "simulate 16 simulate_facets 4 simulate_scaled 2 " + OWN_AFTER
SPECIMEN = "trim 1 trim_facets 1 condense 1 condense_facets 1 reduced_specimen 1 "
WHOLE = """simulate 18 simulate_facets 6 simulate_scaled 16 simulate_step 4 simulate_part 1 simulate_sweeps 6
    simulate_pascal 1 simulate_blocked 1 diagnose_family 4 """
ALL_BONDED = """condense 5 condense_facets 4 condense_part 1 condense_likely 1 reduced_specimen 2 simulate_packed 3
    simulate_packed_facets 3 simulate_likely 3 """
# What a change reruns that computes something; with ... the figures and tables that follow, else nothing more.
PAPER = {
    "a comment in a rule and in a kernel, a number written otherwise": (
        [
            Change("workflow/rules/fit.smk", "", "\n# more\n"),
            Change(
                "src/asphalt_nscd/nscd/bonds/law.py", "import numpy as np\n", "import numpy as np  # arrays\n"
            ),
            key("friction: 0.2\n", "friction: 0.20\n"),
        ],
        "",
    ),
    "the friction of pouring: no looser sample": (
        [key("friction: 0.2\n", "friction: 0.21\n")],
        """deposit 2 trim 2 trim_facets 2 trim_part 1 condense 3 condense_facets 2 condense_part 1 reduced_specimen 2
        simulate_packed 1 simulate_packed_facets 1 """
        + WHOLE
        + AFTER_DIAGNOSIS,
    ),
    "the friction of bonds: no pouring": (
        [key("friction: 0.7", "friction: 0.8")],
        ALL_BONDED + WHOLE + AFTER_DIAGNOSIS,
    ),
    "a row of Table 3: the tests of its temperature": (
        [Change(TABLE3, "15,2.43e7", "15,2.44e7")],
        """published_law 1 pascal_law 1 reconstruct 1 reduce 1 fit 3 simulate 6 simulate_facets 2 simulate_likely 1
        simulate_packed 3 simulate_packed_facets 3 simulate_part 1 simulate_step 4 simulate_sweeps 6 simulate_pascal 1
        simulate_blocked 1 """
        + AFTER_DIAGNOSIS,
    ),
    "one frequency more: no test of another, where nothing is drawn anew": (
        [key("- 40\ngeometry", "- 40\n- 50\ngeometry")],
        """simulate 6 simulate_facets_1 6 simulate_scaled_1 16 simulate_likely_1 3 simulate_pascal_1 1
        simulate_blocked_1 1 reconstruct 1 reduce 1 fit 3 draw_family 3 reduce_family 3 diagnose_family 3
        simulate_extended_1 6 """
        + AFTER_DIAGNOSIS,
    ),
    "a kernel of contacts": (
        [meaning("nscd/contacts/coulomb")],
        "compile 2 deposit 2 deposit_loose 2 trim 4 trim_facets 4 trim_likely 1 trim_part 1 "
        + ALL_BONDED
        + WHOLE
        + AFTER_DIAGNOSIS,
    ),
    "a factor more, and a sentence: no other simulation": (
        [key("  - 1.5\n", "  - 1.5\n  - 2.0\n"), meaning("diagnosis/words/sentences")],
        "scale_law 4 simulate_scaled 8 diagnose 1 diagnose_family 4 ...",
    ),
    "the seed of what is reconstructed": (
        [key("seed: 2020", "seed: 2021")],
        "reconstruct 1 reduce 1 fit 3 draw_family 3 reduce_family 3 diagnose_family 3 " + AFTER_DIAGNOSIS,
    ),
}
# Of a table of one's own, whose fitted laws are simulated: one sample, four temperatures, four frequencies.
OWN = {
    "nothing": ([], ""),
    "one |E*|: the law and the tests of its temperature": (
        [Change("mine.csv", "A,10,1,9600", "A,10,1,9700")],
        "reduce 1 fit 1 simulate 4 simulate_facets 1 " + OWN_AFTER,
    ),
    "one frequency more: no test of another": (
        [key("- 25\ngeometry", "- 25\n- 30\ngeometry")],
        "simulate 4 simulate_facets_1 4 simulate_scaled_1 2 simulate_extended_1 4 " + OWN_AFTER,
    ),
    "one frequency less and one sample more: no test at it": (
        [key("- 25\ngeometry", "geometry"), key("  - 1\nstudy", "  - 1\n  - 2\nstudy")],
        "deposit 1 "
        + SPECIMEN
        + "simulate 12 simulate_facets 4 simulate_scaled 2 diagnose 1 name_causes 1 extend 2 simulate_extended 8 ...",
    ),
    "one temperature more": (
        [key("- 30\ntest", "- 30\n- 40\ntest")],
        "fit 1 simulate 4 simulate_facets 1 diagnose 1 name_causes 1 extend 1 simulate_extended 5 ...",
    ),
    "one sample more": (
        [key("  - 1\nstudy", "  - 1\n  - 2\nstudy")],
        "deposit 1 "
        + SPECIMEN
        + "simulate 16 simulate_facets 4 simulate_scaled 2 diagnose 1 name_causes 1 extend 2 simulate_extended 8 ...",
    ),
    "the amplitude": ([key("1.0e-05", "1.1e-05")], CAMPAIGN),
    "how tables are reduced": ([meaning("measurements/reduction")], "reduce 1 fit 4 scale_law 2 " + CAMPAIGN),
    "the vibration": ([key("vibration_s: 0.1", "vibration_s: 0.2")], "deposit 1 " + SPECIMEN + CAMPAIGN),
    "the draws of a diagnosis": ([key("geometry:", "diagnosis:\n  seed: 3\ngeometry:")], OWN_AFTER),
    "an advice: no simulation": ([meaning("diagnosis/next_tests/sweeps")], "diagnose 1 ..."),
    "a cause": ([meaning("diagnosis/causes/damage")], OWN_AFTER),
}


@pytest.fixture(scope="module")
def paper(tmp_path_factory):
    """All rules of the paper's study, of fewer samples, temperatures, frequencies and tables: its plan is slow."""
    study = yaml.safe_load((ROOT / "config/paper.yaml").read_text())
    study |= {"temperatures_C": [0, 15, 20], "frequencies_Hz": [3, 10, 40]}
    study["specimens"]["seeds"] = [1, 2]
    del study["tables_beside"]["tables"][1:]
    return Clone(tmp_path_factory.mktemp("paper"), study)


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    study = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())
    for name in ("published", "audit", "tables_beside", "time_step_study", "packing_study"):
        del study[name]
    study |= {"study": "own", "measurements": {"table": "mine.csv"}, "laws": {"simulate": "fitted"}}
    study |= {"temperatures_C": [0, 10, 20, 30], "frequencies_Hz": [1, 3, 10, 25]}
    return Clone(tmp_path_factory.mktemp("own"), study)


def require(jobs: dict[str, int], expected: str) -> None:
    words = [word for word in expected.split() if word != DRAWN]
    wanted = dict(zip(words[::2], map(int, words[1::2]), strict=True))
    computing = {rule: count for rule, count in jobs.items() if COMPUTES.match(rule)}
    assert (computing if DRAWN in expected else jobs) == wanted


@pytest.mark.parametrize("change", PAPER)
def test_of_the_paper(paper, change):
    changes, expected = PAPER[change]
    require(paper.after(*changes), expected)


@pytest.mark.parametrize("change", OWN)
def test_of_a_table_of_one_s_own(own, change):
    changes, expected = OWN[change]
    require(own.after(*changes), expected)


def test_a_row_that_the_study_does_not_have_and_a_missing_result(paper):
    assert paper.after(Change(TABLE3, "", "40,1e7,1e6,1e7,1e5\n")).get("simulate") is None
    path = paper.folder / "results/paper/tests/s2/T0/f10.h5"
    path.unlink()
    jobs = paper.after()
    path.touch()
    assert jobs["simulate"] == 1 and "published_law" not in jobs


def test_each_stage_is_a_target(own):
    stages = ("laws", "deposits", "specimens", "tests", "tables", "figures", "diagnosis", "extended")
    assert all(f"`{name}`" in (ROOT / "docs/workflow.md").read_text() for name in stages)
    jobs = own.planned("deposits", "tests", "--forceall")
    assert (jobs["deposits"], jobs["deposit"], jobs["tests"], jobs["simulate"]) == (1, 1, 1, 16)
    assert not {"diagnose", "report"} & set(jobs)
