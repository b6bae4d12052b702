"""docs/tutorial.md does what it says, as far as the workflow's plan."""

from __future__ import annotations

import json
import re
import runpy
import shlex
from pathlib import Path

import numpy as np
import pytest
import yaml
from forks import forked

from asphalt_nscd.diagnosis.observed.quality import exceeded
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.table_import.campaign import read_campaign

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
TUTORIAL = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(sh)?\n(.*?)```", TUTORIAL, re.DOTALL)
COMMANDS = [line for kind, block in BLOCKS if kind for line in block.splitlines()]


def new_study(workspace, command):
    return forked("asphalt_nscd.cli:main", shlex.split(command)[1:], workspace.folder)


def test_data_are_made_by_the_tool():
    page = runpy.run_path(str(ROOT / "tools/tutorial_data.py"))["page"]()
    assert (ROOT / "data/tutorial/campaign.csv").read_text(encoding="utf-8") == page
    assert page.startswith("# Synthetic")


def test_exports_are_made_by_the_tool():
    pages = runpy.run_path(str(ROOT / "tools/tutorial_exports.py"))["pages"]()
    folder = ROOT / "data/tutorial/exports"
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == pages
    assert len(pages) == 12 and all(
        b"Comments,Synthetic: no mix was tested." in page for page in pages.values()
    )


def test_exports_are_read_and_the_machine_itself_names_the_artefact():
    campaign, _ = read_campaign([ROOT / "data/tutorial/exports"])
    observed, origin = read_observations(campaign, PAPER_GEOMETRY)
    assert (observed.size, observed.names, origin) == (72, ("Mix-A", "Mix-B", "Mix-C"), "synthetic")
    assert (
        observed.isotherms.tolist() == [4, 20, 35, 50]
        and np.ptp(observed.temperature - observed.isotherm) > 0
    )
    (above,) = exceeded(observed)
    row = above.row
    assert (observed.names[observed.specimen[row]], observed.isotherm[row], observed.frequency[row]) == (
        "Mix-B",
        4,
        25,
    )
    assert above.column == "phase_uniformity_deg"


def test_commands_lead_from_the_table_to_the_plan_of_a_report(workspace):
    small, full = [command for command in COMMANDS if command.startswith("asphalt-nscd new-study")]
    done = new_study(workspace, small)
    assert done.returncode == 0, done.stderr
    said = next(block for kind, block in BLOCKS if not kind and block.startswith("columns"))
    assert done.stdout == said
    assert new_study(workspace, full).returncode == 0
    assert "snakemake --cores all --configfile config/mine.yaml" in COMMANDS
    (workspace.folder / "config/mine.yaml").rename(workspace.folder / "study.yaml")
    planned = workspace.planned()
    assert (
        planned["simulate"] == 4 * planned["simulate_extended"] == 16
        and planned["diagnose"] == planned["report"] == 1
    )
    (workspace.folder / "config/mine-full.yaml").rename(workspace.folder / "study.yaml")
    assert workspace.planned()["deposit"] == 4


def test_options_of_the_tutorial_exist(workspace):
    helped = new_study(workspace, "asphalt-nscd new-study --help").stdout
    helped += new_study(workspace, "asphalt-nscd diagnose --help").stdout
    used = set(re.findall(r"(?<!-)(--[a-z][a-z-]*)", TUTORIAL)) - {"--cores", "--configfile", "--help"}
    assert used and all(option in helped for option in used)


def test_the_folder_of_exports_gets_the_answer_of_the_page(workspace):
    """The output in the tutorial is how the command begins, and its page opens with it."""
    (command,) = [command for command in COMMANDS if command.startswith("asphalt-nscd diagnose")]
    done = new_study(workspace, command)
    assert done.returncode == 0 and not done.stderr, done.stderr
    said = next(block for kind, block in BLOCKS if not kind and block.startswith("Tests "))
    assert done.stdout.startswith(said.removesuffix("...\n")) and said.endswith("...\n")
    html = (workspace.folder / "diagnosis/diagnosis.html").read_text(encoding="utf-8")
    assert "71 of 72 tests can be used after correction, 1 cannot." in html
    assert "Channel delay in all tests, 0.787 ± 0.018 ms." in html
    assert "Correction: subtract 0.283° per Hz from the phase." in html
    content = json.loads((workspace.folder / "diagnosis/diagnosis.json").read_text(encoding="utf-8"))
    (aside,) = content["unexplained"]  # of the law with the delay, as the reason says: 18.8 less 13.9 deg
    assert aside["residual_phase_deg"] == pytest.approx(4.9, abs=0.5)
    drawn = re.findall(r'<figure class="chart" id="chart-([a-z]+)">', html)
    assert drawn == ["law", "specimens", "causality", "residuals"]


def test_exports_of_a_machine_lead_to_a_study_of_a_cylinder(workspace):
    """Synthetic ones in the layout of an AMPT: all their temperatures and frequencies are planned, and the report."""
    done = new_study(workspace, "asphalt-nscd new-study ampt --measurements data/tutorial/exports --small")
    assert done.returncode == 0, done.stderr
    (workspace.folder / "config/ampt.yaml").rename(workspace.folder / "study.yaml")
    study = yaml.safe_load((workspace.folder / "study.yaml").read_text(encoding="utf-8"))
    assert study["test"]["type"] == "tension-compression" and "d_mm" in study["specimens"]["geometry"]
    planned = workspace.planned()
    tests = len(study["temperatures_C"]) * len(study["frequencies_Hz"])
    assert tests == 4 * 6 and planned["simulate"] == tests
    assert planned["diagnose"] == planned["report"] == planned["fig_forces"] == planned["fig05"] == 1
