"""Options that several steps share."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Any

import click

from asphalt_nscd.files.ranges import Range
from asphalt_nscd.measurements.kinds import TEST_TYPES

TRAPEZOID = ("b_mm", "B_mm", "e_mm", "h_mm", "mass_kg", "mobile_mass_kg")
CYLINDER = ("d_mm", "h_mm", "mass_kg", "mobile_mass_kg")
BEAM = ("L_mm", "H_mm", "B_mm", "mass_kg", "mobile_mass_kg")

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

    def __init__(self, *known: tuple[str, ...]) -> None:
        self.known = known or (TRAPEZOID,)

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        # A path, or what click has converted before.
        if not isinstance(value, str) or "=" not in value:
            return value
        try:
            pairs = (item.split("=") for item in value.split(","))
            geometry = {key.strip(): float(number) for key, number in pairs}
        except ValueError:
            self.fail(f"{value!r} is not of the form b_mm=25,B_mm=56,...", param, context)
        if set(geometry) not in [set(keys) for keys in self.known]:
            known = " or ".join(", ".join(keys) for keys in self.known)
            self.fail(f"{value!r} must give {known}, each once.", param, context)
        return geometry


geometry = click.option("--geometry", required=True, type=Geometry(), help="Trapezoidal specimen.")
shape = click.option(
    "--geometry",
    required=True,
    type=Geometry(TRAPEZOID, CYLINDER, BEAM),
    help="Trapezoid in two-point bending; cylinder in tension-compression: d_mm,h_mm,mass_kg,mobile_mass_kg; prism in "
    "four-point bending: L_mm,H_mm,B_mm,mass_kg,mobile_mass_kg.",
)


class Number(click.ParamType):
    """A finite number within limits, those of a `Range`."""

    name = "number"

    def __init__(self, **limits: float) -> None:
        self.limits = limits

    @property
    def range(self) -> Range:
        """What is taken."""
        return Range(**self.limits)

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> float:
        try:
            number = float(value)
        except (TypeError, ValueError):
            # NaN lies in no range, so that one sentence refuses both.
            number = float("nan")
        if not self.range.holds(number):
            self.fail(f"{value!r} must be a number {self.range}.", param, context)
        return number


class Of(Number):
    """What a field of a dataclass takes: `Of("bending.condensing.Bonds.friction")`.

    unit: of the option, in that of the field. The class is imported when a value is judged.
    """

    def __init__(self, field: str, unit: float = 1.0) -> None:
        self.field, self.unit = field, unit

    @property
    def range(self) -> Range:
        module, name, field = self.field.rsplit(".", 2)
        fields = getattr(import_module(f"asphalt_nscd.{module}"), name).__dataclass_fields__
        limits = vars(fields[field].metadata["range"])
        return Range(**{limit: value / self.unit for limit, value in limits.items()})


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


law = click.option(
    "--law",
    default="2s2p1d",
    # Written out: to load the laws would take every command 0.2 s.
    type=click.Choice(["2s2p1d", "huet-sayegh", "sigmoid", "cam"]),
    help="Form of the law in law.json; sigmoid is that of AASHTO R 84. Misfits of all four are compared.",
)
measured_in = click.option(
    "--measured-in",
    type=click.Choice(list(TEST_TYPES)),
    help="Test that gave the moduli; else what the files say.",
)
column = click.option(
    "--column",
    "columns",
    multiple=True,
    type=Choice(),
    help="What a column holds, if its name does not say.",
)
