"""Examples in docstrings are run: a reader may trust them."""

from __future__ import annotations

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import asphalt_nscd

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "src"
MODULES = [
    ".".join(path.relative_to(SOURCES).with_suffix("").parts)
    for path in sorted(SOURCES.rglob("*.py"))
    if ">>> " in path.read_text(encoding="utf-8") and path.name != "__init__.py"
]


@pytest.mark.parametrize("name", MODULES)
def test_examples(name, monkeypatch):
    monkeypatch.chdir(ROOT)  # examples read data/tutorial
    failed, tried = doctest.testmod(import_module(name))
    assert tried and not failed


def test_the_example_of_the_package(monkeypatch):
    monkeypatch.chdir(ROOT)
    for name in asphalt_nscd.__all__:  # doctest walks over the names of a module, which loads them when asked
        getattr(asphalt_nscd, name)
    failed, tried = doctest.testmod(asphalt_nscd)
    assert tried and not failed
