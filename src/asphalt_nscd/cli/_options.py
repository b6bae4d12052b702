"""Options that several steps share."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

GEOMETRY_KEYS = ("b_mm", "B_mm", "e_mm", "h_mm", "mass_kg", "mobile_mass_kg")

File = click.Path(path_type=Path)
output = click.option("--output", required=True, type=File, help="File to write.")
outputs = click.option(
    "--output", "outputs", required=True, multiple=True, type=File, help="File to write, one for each."
)


def gather(name: str, /, **keys: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Hand options over as one mapping `name`: its keys, each with the option whose value it gets."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        @wraps(command)
        def gathered(**options: Any) -> None:
            together = {key: options.pop(option) for key, option in keys.items()}
            command(**options, **{name: together})

        return gathered

    return decorate


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


class Number(click.ParamType):
    """A finite number within limits; `above` and `below` are excluded themselves."""

    name = "number"

    def __init__(
        self,
        above: float | None = None,
        low: float | None = None,
        below: float | None = None,
        high: float | None = None,
    ) -> None:
        self.limits = [
            (above, "greater than", lambda x, limit: x > limit),
            (low, "at least", lambda x, limit: x >= limit),
            (below, "less than", lambda x, limit: x < limit),
            (high, "at most", lambda x, limit: x <= limit),
        ]

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> float:
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        limits = [(words, limit, holds) for limit, words, holds in self.limits if limit is not None]
        if not math.isfinite(number) or not all(holds(number, limit) for _, limit, holds in limits):
            wanted = " and ".join(f"{words} {limit:g}" for words, limit, _ in limits) or "finite"
            self.fail(f"{value!r} must be a number {wanted}.", param, context)
        return number


POSITIVE = Number(above=0.0)
NOT_NEGATIVE = Number(low=0.0)


class Numbers(click.ParamType):
    """`0.25,0.025,1.6` as numbers above `low`, all different or so many as `size` says."""

    name = "number,..."

    def __init__(self, size: int | None = None, low: float = 0.0) -> None:
        self.size, self.low = size, low

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        try:
            numbers = tuple(float(part) for part in value.split(","))
        except ValueError:
            numbers = ()
        fits = len(set(numbers)) == len(numbers) if self.size is None else len(numbers) == self.size
        if not numbers or not fits or not all(self.low < number < float("inf") for number in numbers):
            wanted = "different" if self.size is None else str(self.size)
            sort = "positive numbers" if self.low == 0.0 else f"numbers greater than {self.low:g}"
            self.fail(f"{value!r} is not {wanted} {sort} joined by commas.", param, context)
        return numbers


class Choice(click.ParamType):
    """`E_GPa=Steifigkeit`: what a column holds, in our names with its unit, and how the table calls it."""

    name = "quantity_unit=column"

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        quantity, equals, column = value.partition("=")
        if not equals or not quantity.strip() or not column.strip():
            self.fail(f"{value!r} is not of the form E_GPa=column.", param, context)
        return quantity.strip(), column.strip()


column = click.option(
    "--column",
    "columns",
    multiple=True,
    type=Choice(),
    help="What a column holds, if its name does not say.",
)
