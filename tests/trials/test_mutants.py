"""Mutants that no longer fit the sources would be alive for ever."""

from __future__ import annotations

import pytest
from mutants import MUTANTS, PACKAGE, ROOT


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.what)
def test_each_mutant_changes_its_file_once_and_has_its_tests(mutant):
    assert (ROOT / PACKAGE / mutant.file).read_text(encoding="utf-8").count(mutant.right) == 1
    assert mutant.right != mutant.wrong and (ROOT / "tests" / mutant.tests).is_file()
