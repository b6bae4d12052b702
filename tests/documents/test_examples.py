"""Examples in docstrings are run: a reader may trust them."""

from __future__ import annotations

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import asphalt_nscd

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
MODULES = [
    "api.arguments", "api.bending", "api.comparison", "api.contacts", "api.diagnosis", "api.exporting",
    "api.fatigue", "api.forecasting", "api.laws", "api.ramp", "api.reading", "api.specimens", "bending.case",
    "bending.further_settings", "bending.settings",
    "bending.fatigue", "bending.rig", "diagnosis.run", "files.errors", "files.words", "measurements.signals",
    "files.options", "files.ranges", "measurements.twopoint", "diagnosis.settings", "exports.settings",
    "nscd.contacts.friction", "rheology.burgers", "rheology.chain", "rheology.fitting", "rheology.laws_of_modulus",
    "rheology.parabolic", "rheology.shift", "specimen.settings",
]  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
def test_examples(name, monkeypatch):
    monkeypatch.chdir(ROOT)  # examples read data/tutorial
    failed, tried = doctest.testmod(import_module(f"asphalt_nscd.{name}"))
    assert tried and not failed


def test_the_example_of_the_package(monkeypatch):
    monkeypatch.chdir(ROOT)
    for name in asphalt_nscd.__all__:  # doctest walks over the names of a module, which loads them when asked
        getattr(asphalt_nscd, name)
    failed, tried = doctest.testmod(asphalt_nscd)
    assert tried and not failed
