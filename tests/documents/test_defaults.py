"""A default stands in a dataclass, at the command line, in the schema and, as the paper's, in config/paper.yaml."""

from __future__ import annotations

from importlib import import_module
from inspect import signature
from pathlib import Path
from pkgutil import iter_modules

import click
import pytest
import yaml

import asphalt_nscd as an
from asphalt_nscd import cli
from asphalt_nscd.cli._options import Of
from asphalt_nscd.nscd.contacts.friction import solve_contacts

ROOT = Path(__file__).parents[2]
# Section of a study: the steps whose options its keys become.
SECTIONS = {"specimens.deposit": ["deposit"], "specimens.bonds": ["trim", "condense"], "test": ["simulate"]}


def command(name: str) -> click.Command:
    return import_module(f"asphalt_nscd.cli.{name}").command


def options() -> list:
    names = [one.name for one in iter_modules(cli.__path__) if not one.name.startswith("_")]
    return [
        pytest.param(option, id=f"{name} {option.opts[-1]}")
        for name in names
        for option in command(name).params
        if isinstance(option.type, Of)
    ]


def section(content: dict, place: str, inner: str = "") -> dict:
    for key in place.split("."):
        content = content[inner][key] if inner else content[key]
    return content


@pytest.mark.parametrize("option", options())
def test_an_option_has_the_default_of_its_field(option):
    module, name, field = option.type.field.rsplit(".", 2)
    default = getattr(import_module(f"asphalt_nscd.{module}"), name).__dataclass_fields__[field].default
    if option.required:
        return
    assert (None if option.default is None else option.default * option.type.unit) == pytest.approx(default)


@pytest.mark.parametrize(
    ("function", "step"),
    [(an.pour, "deposit"), (an.specimen, "trim"), (an.forecast, "forecast"), (solve_contacts, "fclib")],
)
def test_a_function_has_the_defaults_of_the_command_line(function, step):
    theirs = {option.name: option.default for option in command(step).params if option.name != "threads"}
    ours = {name: one.default for name, one in signature(function).parameters.items()}
    shared = [name for name in ours.keys() & theirs.keys() if isinstance(theirs[name], int | float)]
    assert shared and {name: ours[name] for name in shared} == {name: theirs[name] for name in shared}


@pytest.mark.parametrize("place", SECTIONS)
def test_schema_and_paper_have_the_defaults_of_the_command_line(place):
    schema = yaml.safe_load((ROOT / "workflow/schemas/study.schema.yaml").read_text(encoding="utf-8"))
    paper = section(yaml.safe_load((ROOT / "config/paper.yaml").read_text(encoding="utf-8")), place)
    params = {option.name: option for step in SECTIONS[place] for option in command(step).params}
    for key, said in section(schema, place, "properties")["properties"].items():
        option = params.get(key.lower())
        if option is None or said.get("default") is None:
            continue
        assert said["default"] == option.default, key
        assert paper.get(key, option.default) == option.default, key
