"""Examples in docstrings are run: a reader may trust them."""

from __future__ import annotations

import doctest
from importlib import import_module

import pytest

MODULES = [
    "measurements.signals", "measurements.twopoint", "nscd.contacts.friction", "rheology.burgers",
    "rheology.chain", "rheology.fitting", "rheology.shift", "rheology.spectrum",
]  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
def test_examples(name):
    failed, tried = doctest.testmod(import_module(f"asphalt_nscd.{name}"))
    assert tried and not failed
