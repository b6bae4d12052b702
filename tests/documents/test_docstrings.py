"""Docstrings in numpydoc form name the parameters that a function has, in its order, and describe what it returns."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import cached_property
from importlib import import_module
from pkgutil import walk_packages

import pytest
from numba.core.dispatcher import Dispatcher

import asphalt_nscd

numpydoc = pytest.importorskip("numpydoc.validate", reason="of requirements.txt: make test installs it")

# A parameter that is not described, or not there, or in another place; a result that is not described.
WRONG = {"PR01", "PR02", "PR03", "PR04", "PR07", "RT01", "RT03"}
SECTION = re.compile(r"^\s*Parameters\n\s*-{4,}$", re.MULTILINE)


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
    """Functions, classes and methods of all modules without an underscore, by their full names."""
    found = {}
    for one in walk_packages(asphalt_nscd.__path__, "asphalt_nscd."):
        if not any(part.startswith("_") for part in one.name.split(".")):
            for name, value in vars(import_module(one.name)).items():
                if not name.startswith("_"):
                    found |= members(f"{one.name}.{name}", plain(value), one.name)
    return found


def faults(found: object) -> list[str]:
    said = numpydoc.validate(numpydoc.get_doc_object(found))["errors"]
    return [f"{code} {sentence}" for code, sentence in said if code in WRONG]


def described(found: object) -> bool:
    return bool(SECTION.search(inspect.getdoc(found) or ""))


@pytest.mark.slow  # imports every module
def test_what_a_docstring_says_of_parameters_is_so():
    wrong = {name: said for name, one in public().items() if described(one) and (said := faults(one))}
    assert not wrong


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
