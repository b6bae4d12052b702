"""A study writes every format of laws, and the page names it."""

from __future__ import annotations

import re
from pathlib import Path

from asphalt_nscd.exports.formats import FORMATS, format_of

ROOT = Path(__file__).parents[2]


def test_a_study_writes_every_format():
    rules = (ROOT / "workflow/rules/exports.smk").read_text(encoding="utf-8")
    written = dict(re.findall(r'^    "(\w+)": "<results>.*(\.\w+)",$', rules, re.MULTILINE))
    assert set(written) == set(FORMATS)
    assert all(ending in format_of(form).ENDINGS for form, ending in written.items())


def test_the_page_names_every_format():
    page = (ROOT / "docs/laws-out.md").read_text(encoding="utf-8")
    named = [
        re.findall(r"`(?:--format )?(\.?\w+)`", told)
        for told in re.findall(r"^\*\*\w+\*\* \((.+?)\)", page, re.MULTILINE)
    ]
    assert {form for form, *_ in named} == set(FORMATS)
    assert all(set(endings) <= set(format_of(form).ENDINGS) for form, *endings in named)
