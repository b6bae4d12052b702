"""The kinds of test stand in Python once, and again where Python cannot be asked: in schemas and rules."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args, get_type_hints

import yaml

from asphalt_nscd.diagnosis.content.reading import Reading
from asphalt_nscd.measurements.further_kinds import ALL_KINDS
from asphalt_nscd.measurements.geometry import USUAL
from asphalt_nscd.measurements.kinds import BENDING, UNKNOWN, usual_steps_per_cycle
from asphalt_nscd.table_import.words import WORDS

ROOT = Path(__file__).parents[2]
STUDY = "src/asphalt_nscd/study/study.schema.yaml"


def properties(schema: str, *keys: str) -> dict:
    content = yaml.safe_load((ROOT / schema).read_text(encoding="utf-8"))
    for key in keys:
        content = content["properties"][key]
    return content


def test_what_can_be_diagnosed():
    assert set(WORDS["scheme"]) == set(ALL_KINDS)
    for section in ("diagnosis", "tables_beside"):
        assert properties(STUDY, section, "measured_in")["enum"] == list(ALL_KINDS)
    assert get_args(get_type_hints(Reading)["test_type"]) == (*ALL_KINDS, UNKNOWN)


def test_what_can_be_simulated():
    assert properties(STUDY, "test", "type")["enum"] == list(USUAL)
    assert [usual_steps_per_cycle(test) for test in USUAL] == [None, 200, 200]
    rules = (ROOT / "workflow/rules/rigs.smk").read_text(encoding="utf-8")
    assert [BENDING, *re.findall(r'"\w+": "([\w -]+)"', rules)] == list(USUAL)
