"""The profile for Slurm, as far as it can be looked at without a cluster; `make cluster` starts one."""

from __future__ import annotations

import re

import pytest
import yaml
from workspace import ROOT

pytestmark = pytest.mark.slow

PROFILE = yaml.safe_load((ROOT / "profiles/slurm/config.yaml").read_text())
RULES = "".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
LOCAL = {"all", "study", "timings", "workflow_report"}  # beside Snakemake, not on the cluster


def test_every_rule_and_group_of_the_profile_stands_in_the_workflow(workspace):
    workspace.configure()
    listed = workspace.run("--list-rules")
    assert listed.returncode == 0, listed.stderr
    rules = set(re.findall(r"^\s*(\w+)", listed.stdout, re.MULTILINE))
    assert {*PROFILE["groups"], *PROFILE["set-resources"]} <= rules
    groups = {*PROFILE["groups"].values(), *re.findall(r'group:\n\s+"(\w+)"', RULES)}
    assert set(PROFILE["group-components"]) == groups


def test_every_job_of_a_study_is_in_a_chunk(workspace):
    workspace.configure()
    flags = "--profile", "profiles/slurm", "--slurm-chunks-no-account"
    plan = workspace.plan(*flags)
    said = "\n".join(plan.lines)
    chunks = re.findall(r"^\[.*\] Group job (\w+)", said, re.MULTILINE)
    assert set(chunks) == set(PROFILE["group-components"])
    assert len(chunks) < sum(plan.jobs.values()) / 4
    alone = re.findall(r"^Job \d+: (.*)", said, re.MULTILINE)
    assert len(alone) == len(LOCAL) - 1, alone
