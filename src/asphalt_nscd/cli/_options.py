"""Options that several steps share."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

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
