"""`import asphalt_nscd as an`: what it offers, that it starts fast, and that the command line does the same."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from documents.test_examples import MODULES

import asphalt_nscd as an
from asphalt_nscd.nscd.contacts import friction

STUB = Path(an.__file__).with_suffix(".pyi")


def test_import_loads_nothing_heavy():
    script = (
        "import sys, asphalt_nscd as an; dir(an)\n"
        "heavy = {'numpy', 'pandas', 'scipy', 'numba', 'h5py', 'matplotlib'}; print(heavy & set(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout == "set()\n"


def test_a_diagnosis_starts_without_what_takes_long_to_import():
    script = (
        "import sys, asphalt_nscd.api.diagnosis\n"
        "print({'scipy.stats', 'numba', 'matplotlib'} & set(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout == "set()\n"


def test_the_stub_of_editors_names_the_same_from_the_same_modules():
    named = re.findall(r"^from ([\w.]+) import (\w+) as \2$", STUB.read_text(), re.MULTILINE)
    assert sorted(name for _, name in named) == sorted(an.__all__)
    for module, name in named:
        assert inspect.unwrap(getattr(an, name)).__module__ == module


@pytest.mark.parametrize("name", an.__all__)
def test_every_public_name_is_documented_with_an_example_that_the_tests_run(name):
    thing = inspect.unwrap(getattr(an, name))
    assert ">>>" in thing.__doc__
    assert thing.__module__ in MODULES


@pytest.mark.parametrize(
    ("function", "step"),
    [
        (an.pour, "deposit"),
        (an.specimen, "trim"),
        (an.solve_contacts, "fclib"),
        (friction.solve_contacts, "fclib"),
    ],
)
def test_a_function_has_the_defaults_of_the_command_line(function, step):
    params = import_module(f"asphalt_nscd.cli.{step}").command.params
    theirs = {option.name: option.default for option in params if option.name != "threads"}
    ours = {name: one.default for name, one in inspect.signature(function).parameters.items()}
    shared = [name for name in ours.keys() & theirs.keys() if isinstance(theirs[name], int | float)]
    assert shared and {name: ours[name] for name in shared} == {name: theirs[name] for name in shared}


@pytest.mark.slow
@pytest.mark.parametrize("before", ["", "import asphalt_nscd.specimen.preparation; "])
def test_specimen_is_the_function_although_a_folder_has_its_name(before):
    script = (
        f"{before}import asphalt_nscd as an, inspect\n"
        "print(next(iter(inspect.signature(an.specimen).parameters)))\n"
        "import asphalt_nscd.specimen.counts as counts; print(counts.MOST_SPHERES)\n"
        "try: an.specimen('no.h5')\n"
        "except an.InputError as error: print(error)"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout
    assert said == "packing\n10000000\nno.h5: no such file; run the rule that makes it, or check the path.\n"
