"""What the documents name exists: modules behind equations, files, the citation."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
EQUATIONS = re.findall(
    r"^\| Eqs?\. \((\d+)\)(?:-\((\d+)\))?.*?\|(.*)\|$",
    (ROOT / "docs/equations.md").read_text(encoding="utf-8"),
    re.MULTILINE,
)
PAGES = ["ARCHITECTURE.md", "CONTRIBUTING.md"]


@pytest.mark.parametrize("name", [name for *_, cell in EQUATIONS for name in re.findall(r"`([\w.]+)`", cell)])
def test_name_behind_an_equation_can_be_imported(name):
    parts = name.split(".")
    modules = [part for part in parts if part.islower()]
    for end in range(len(modules), 0, -1):
        try:
            found = import_module(".".join(["asphalt_nscd", *modules[:end]]))
        except ModuleNotFoundError:
            continue
        for part in parts[end:]:
            found = getattr(found, part)
        assert found is not None
        return
    raise AssertionError(f"no module of {name}")


def test_every_equation_of_the_paper_is_there():
    numbers = [n for first, last, _ in EQUATIONS for n in range(int(first), int(last or first) + 1)]
    assert numbers == list(range(1, 34))


@pytest.mark.parametrize("page", PAGES)
def test_files_named_exist(page):
    """Paths from the root or from the package, with `.py` or without; NAME is any."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for path in re.findall(r"`((?:[\w.]+/)+[\w.]*)`", text):
        places = [base / (path + end) for base in (ROOT, ROOT / "src/asphalt_nscd") for end in ("", ".py")]
        assert "NAME" in path or any(place.exists() for place in places), path


def test_citation_and_catalogue_can_be_read():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["references"][0]["doi"] == "10.1016/j.compgeo.2019.103255"
    assert f'version = "{citation["version"]}"' in (ROOT / "pyproject.toml").read_text()
    assert yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text())["usage"]["report"] is True
