"""Findings as rows of the audit."""

from pathlib import Path
from types import SimpleNamespace

import yaml

from studies.paper.audit import judged

STATEMENTS = Path(__file__).parents[3] / "studies/paper/statements.yaml"


def by_id(findings):
    """Rows of audit.csv by id, of these findings."""
    listed = {row["id"]: row for row in yaml.safe_load(STATEMENTS.read_text(encoding="utf-8"))}
    return {finding.id: SimpleNamespace(**judged(listed[finding.id], finding)) for finding in findings}


def judgement(finding):
    """The row of one finding."""
    return by_id([finding])[finding.id]
