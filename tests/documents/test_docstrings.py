"""What a user imports has a docstring in numpydoc form that names its parameters; everything else has no sections."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from functools import cached_property
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest
from numba.core.dispatcher import Dispatcher

import asphalt_nscd
from asphalt_nscd import api

numpydoc = pytest.importorskip("numpydoc.validate", reason="of requirements.txt: make test installs it")

# A parameter that is not described, or not there, or in another place; a result that is not described.
WRONG = {"PR01", "PR02", "PR03", "PR04", "PR07", "RT01", "RT03"}
SECTION = re.compile(r"^\s*Parameters\n\s*-{4,}$", re.MULTILINE)
ANY_SECTION = re.compile(r"^\s*(Parameters|Attributes|Returns|Yields|Raises)\n\s*-{4,}$", re.MULTILINE)
SOURCES = Path(asphalt_nscd.__file__).parent
DEFINITIONS = (ast.FunctionDef, ast.ClassDef)


def plain(found: object) -> object:
    """What was decorated."""
    if isinstance(found, property):
        found = found.fget
    elif isinstance(found, cached_property):
        found = found.func
    elif isinstance(found, classmethod | staticmethod):
        found = found.__func__
    elif isinstance(found, Dispatcher):
        found = found.py_func
    return inspect.unwrap(found) if inspect.isfunction(found) else found


def members(name: str, found: object, module: str) -> Iterator[tuple[str, object]]:
    """A function, or a class and its public methods, if it is one of ours."""
    if not (inspect.isfunction(found) or inspect.isclass(found)) or not found.__module__.startswith(module):
        return
    yield name, found
    if inspect.isclass(found):
        for key, value in vars(found).items():
            if not key.startswith("_") and inspect.isfunction(plain(value)):
                yield f"{name}.{key}", plain(value)


def public() -> dict[str, object]:
    """What a user imports: the names of `__all__`, and those of the modules in `api/`, by their full names."""
    modules = [import_module(f"asphalt_nscd.api.{module.name}") for module in iter_modules(api.__path__)]
    values = {(module.__name__, name): value for module in modules for name, value in vars(module).items()}
    values |= {("asphalt_nscd", name): getattr(asphalt_nscd, name) for name in asphalt_nscd.__all__}
    documented = {}
    for (module, name), value in values.items():
        if not name.startswith("_"):
            documented |= members(f"{module}.{name}", plain(value), module)
    return documented


def sections_elsewhere(path: Path) -> list[str]:
    """Functions and classes of a file that describe their parameters in a section, but that no user imports."""
    module = ".".join(path.relative_to(SOURCES).with_suffix("").parts)
    return [
        f"{module}: {top.name}.{node.name}" if node is not top else f"{module}: {top.name}"
        for top in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(top, DEFINITIONS) and asphalt_nscd._NAMES.get(top.name) != module
        for node in ast.walk(top)
        if isinstance(node, DEFINITIONS) and ANY_SECTION.search(ast.get_docstring(node) or "")
    ]


def faults(found: object) -> list[str]:
    said = numpydoc.validate(numpydoc.get_doc_object(found))["errors"]
    return [f"{code} {sentence}" for code, sentence in said if code in WRONG]


def described(found: object) -> bool:
    return bool(SECTION.search(inspect.getdoc(found) or ""))


@pytest.mark.slow  # imports every module
def test_what_a_docstring_says_of_parameters_is_so():
    wrong = {name: said for name, one in public().items() if described(one) and (said := faults(one))}
    assert not wrong


def test_only_what_a_user_imports_has_sections():
    internals = [path for path in SOURCES.rglob("*.py") if path.parent.name != "api"]
    assert not [name for path in internals for name in sections_elsewhere(path)]


@pytest.mark.parametrize("name", [name for name in asphalt_nscd.__all__ if name != "InputError"])
def test_the_public_names_have_all_sections(name):
    for called, one in members(name, plain(getattr(asphalt_nscd, name)), "asphalt_nscd"):
        takes = [key for key in inspect.signature(one).parameters if key not in ("self", "cls")]
        assert described(one) or not takes, f"{called} describes none of {takes}"


def test_a_wrong_name_is_noticed():
    def speed(distance: float, time: float) -> float:
        """Mean speed.

        Parameters
        ----------
        distance : float
            Way gone [m].
        duration : float
            Time taken [s].

        Returns
        -------
        float
            Speed [m/s].
        """
        return distance / time

    assert [said[:4] for said in faults(speed)] == ["PR01", "PR02"]
