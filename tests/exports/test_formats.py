"""A format of laws stands in five places; none may be forgotten."""

from __future__ import annotations

import re
from importlib import import_module
from inspect import getdoc
from pathlib import Path

from asphalt_nscd.api.exporting import export
from asphalt_nscd.exports.formats import FORMATS, SOLIDS

ROOT = Path(__file__).parents[2]


def test_every_format_has_a_module_and_an_ending():
    for module, endings in FORMATS.values():
        assert import_module(f"asphalt_nscd.exports.{module}") and all(end.startswith(".") for end in endings)
    assert set(SOLIDS) < set(FORMATS)


def test_a_study_writes_every_format():
    rules = (ROOT / "workflow/rules/exports.smk").read_text(encoding="utf-8")
    written = dict(re.findall(r'^    "(\w+)": "<results>.*(\.\w+)",$', rules, re.MULTILINE))
    assert set(written) == set(FORMATS)
    assert all(ending in FORMATS[form][1] for form, ending in written.items())


def test_the_documents_name_every_format():
    docstring = re.search(r"Of a law ([\w, \n]+);", getdoc(export) or "")
    assert docstring and set(re.findall(r"\w+", docstring[1])) - {"or"} == set(FORMATS)
    page = (ROOT / "docs/laws-out.md").read_text(encoding="utf-8")
    said = [
        re.findall(r"`(?:--format )?(\.?\w+)`", told)
        for told in re.findall(r"^\*\*\w+\*\* \((.+?)\)", page, re.MULTILINE)
    ]
    assert {form for form, *_ in said} == set(FORMATS)
    assert all(set(endings) <= set(FORMATS[form][1]) for form, *endings in said)
