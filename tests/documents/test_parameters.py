"""No function takes more than seven parameters, compiled kernels excepted."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from asphalt_nscd.workflow_support.sources import PACKAGE

MOST = 7
COMPILED = {"compiled", "compiled_for_teams", "cfunc"}  # decorators: arrays in, arrays out, and no objects


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and not COMPILED & set(map(decorator, node.decorator_list)):
            yield node


def decorator(node: ast.expr) -> str:
    """`compiled`, of @compiled, @compiled(...) and @module.compiled."""
    called = node.func if isinstance(node, ast.Call) else node
    return called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")


def parameters(function: ast.FunctionDef) -> list[str]:
    """Names, without that of the object itself."""
    of = function.args
    named = [*of.posonlyargs, *of.args, *of.kwonlyargs]
    starred = [part for part in (of.vararg, of.kwarg) if part is not None]
    return [part.arg for part in named + starred if part.arg not in ("self", "cls")]


def test_no_function_takes_more_than_seven():
    found = {}
    for file in PACKAGE.rglob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        long = {function.name for function in functions(tree) if len(parameters(function)) > MOST}
        if long:
            found[file.relative_to(PACKAGE).as_posix()] = long
    assert not found, "put what belongs together into one object; for commands, see `_options.gather`"


def test_parameters_are_counted_whatever_their_kind():
    source = "class A:\n @m.other(1)\n def f(self, a, /, b, *c, d=1, **e): ...\n @compiled\n def g(): ..."
    (found,) = functions(ast.parse(source))
    assert parameters(found) == ["a", "b", "d", "c", "e"]
