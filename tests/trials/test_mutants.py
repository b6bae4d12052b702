"""Mutants that no longer fit the sources would be alive for ever."""

from __future__ import annotations

import ast
import builtins

import pytest
from mutants import MUTANTS, PACKAGE, ROOT, Copy


def unbound(text: str) -> set[str]:
    """Names that a module uses and neither imports nor defines: with one of these every test would fail."""
    nodes = list(ast.walk(ast.parse(text)))
    names = [node for node in nodes if isinstance(node, ast.Name)]
    bound = {*dir(builtins), "__file__"} | {one.id for one in names if not isinstance(one.ctx, ast.Load)}
    bound |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    bound |= {getattr(node, "name", None) for node in nodes if not isinstance(node, ast.alias)}
    bound |= {(node.asname or node.name).split(".")[0] for node in nodes if isinstance(node, ast.alias)}
    return {one.id for one in names} - bound


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.what)
def test_each_mutant_changes_its_file_once_and_has_its_tests(mutant):
    text = (ROOT / PACKAGE / mutant.file).read_text(encoding="utf-8")
    assert text.count(mutant.right) == 1
    # Of a template no name is bound here.
    assert not mutant.file.endswith(".py") or not unbound(text.replace(mutant.right, mutant.wrong))
    assert mutant.right != mutant.wrong and (ROOT / "tests" / mutant.tests).is_file()


@pytest.mark.slow
def test_a_mutant_is_noticed_and_one_that_changes_nothing_is_not(tmp_path):
    copy = Copy(tmp_path)
    mutant = next(one for one in MUTANTS if one.tests == "theory/test_law.py")
    assert copy.noticed(mutant).startswith(f"FAILED tests/{mutant.tests}")
    assert copy.noticed(mutant._replace(wrong=f"{mutant.right} 0.0 +")) == ""
