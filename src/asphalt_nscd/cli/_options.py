"""Options that several steps share."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

import click

from asphalt_nscd.errors import InputError

GEOMETRY_KEYS = ("b_mm", "B_mm", "e_mm", "h_mm", "mass_kg", "mobile_mass_kg")

File = click.Path(path_type=Path)
output = click.option("--output", required=True, type=File, help="File to write.")


class Geometry(click.ParamType):
    """`b_mm=25,B_mm=56,...` as a mapping, or the path of a table."""

    name = "key=value,... or file"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        if not isinstance(value, str) or "=" not in value:
            return value
        try:
            pairs = (item.split("=") for item in value.split(","))
            geometry = {key.strip(): float(number) for key, number in pairs}
        except ValueError:
            self.fail(f"{value!r} is not of the form b_mm=25,B_mm=56,...", param, context)
        if set(geometry) != set(GEOMETRY_KEYS):
            self.fail(f"{value!r} must give {', '.join(GEOMETRY_KEYS)}, each once.", param, context)
        return geometry


geometry = click.option("--geometry", required=True, type=Geometry(), help="Trapezoidal specimen.")


class Lengths(click.ParamType):
    """`0.25,0.025,1.6` as so many positive numbers."""

    name = "number,..."

    def __init__(self, size: int) -> None:
        self.size = size

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        try:
            numbers = tuple(float(part) for part in value.split(","))
        except ValueError:
            numbers = ()
        if len(numbers) != self.size or not all(0 < number < float("inf") for number in numbers):
            self.fail(f"{value!r} is not {self.size} positive numbers joined by commas.", param, context)
        return numbers


class Data(click.ParamType):
    """`simulations=results/paper/simulations.csv` as (kind, path)."""

    name = "kind=path"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        kind, equals, path = value.partition("=")
        if not equals or not kind.isidentifier() or not path:
            self.fail(f"{value!r} is not of the form kind=path.", param, context)
        return kind, Path(path)


def grouped(data: Iterable[tuple[str, Path]]) -> dict[str, list[Path]]:
    """All paths of each kind."""
    kinds: dict[str, list[Path]] = {}
    for kind, path in data:
        kinds.setdefault(kind, []).append(path)
    return kinds


def part(package: str, name: str) -> ModuleType:
    """Module `name` of the figures or tables."""
    if find_spec(f"asphalt_nscd.{package}.{name}") is None:
        raise InputError(f"{name!r} is not among the {package}; the modules of asphalt_nscd.{package} are.")
    return import_module(f"asphalt_nscd.{package}.{name}")
