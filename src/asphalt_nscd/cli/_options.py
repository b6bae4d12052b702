"""Commands made of functions: what stands before `*` are arguments, what stands behind it options (`files.options`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, is_dataclass
from functools import partial, wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, get_args, get_origin

import click

from asphalt_nscd.files.options import Option, hints_of, option, option_of, options_of
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.measurements.further_kinds import ALL_KINDS

TRAPEZOID = ("b_mm", "B_mm", "e_mm", "h_mm", "mass_kg", "mobile_mass_kg")
CYLINDER = ("d_mm", "h_mm", "mass_kg", "mobile_mass_kg")
BEAM = ("L_mm", "H_mm", "B_mm", "mass_kg", "mobile_mass_kg")

File = click.Path(path_type=Path)


def step(function: Callable[..., None] | None = None, /, **settings: Any) -> Any:
    """The command of a function; `settings` are those of click.

    A parameter that is a dataclass takes the options of its fields, or those that `offered` names. An annotation
    `tuple[Path, ...]` takes several, `Sequence[float]` numbers joined by commas.
    """
    if function is None:
        return partial(step, **settings)
    hints = hints_of(function)
    params: list[click.Parameter] = []
    declared: dict[str, Option] = {}
    for name, parameter in signature(function).parameters.items():
        if is_dataclass(hints[name]):
            params += map(_option, _options_in(hints[name], parameter.default))
            continue
        default = option("") if parameter.default is Parameter.empty else parameter.default
        declared[name] = option_of(name, default, hints[name])
        params.append((_option if parameter.kind is Parameter.KEYWORD_ONLY else _argument)(declared[name]))

    @wraps(function)
    def run(**values: Any) -> None:
        given = {name: values[_name(declaration)] for name, declaration in declared.items()}
        made = {name: _made(hint, values) for name, hint in hints.items() if is_dataclass(hint)}
        function(**given, **made)

    return click.command(params=params, **settings)(run)


def offered(*fields: str) -> Any:
    """The fields of a parameter's dataclass that the command offers."""
    return fields


def _options_in(kind: Any, names: Any = Parameter.empty) -> Iterator[Option]:
    """Options of a dataclass and of those in it, in the order of the fields."""
    for name, hint in hints_of(kind).items():
        if is_dataclass(hint):
            yield from _options_in(hint)
        elif name in options_of(kind) and (names is Parameter.empty or name in names):
            yield options_of(kind)[name]


def _made(kind: Any, values: Mapping[str, Any]) -> Any:
    """The dataclass `kind` of the values that click gives by name; fields not offered keep their defaults."""
    given = {
        name: declared.stored(values[_name(declared)])
        for name, declared in options_of(kind).items()
        if _name(declared) in values
    }
    inner = {name: _made(hint, values) for name, hint in hints_of(kind).items() if is_dataclass(hint)}
    return kind(**given, **inner)


def _name(declared: Option) -> str:
    """Name of click's parameter for an option."""
    return declared.key.lower()


def _option(declared: Option) -> click.Option:
    word, flag = _name(declared).replace("_", "-"), declared.annotation is bool
    more: dict[str, Any] = (
        {"is_flag": True} if flag else {"type": _type(declared), "multiple": _is_repeated(declared)}
    )
    return click.Option(
        [f"--{word}/--no-{word}" if flag and declared.default else f"--{word}", _name(declared)],
        help=declared.help,
        **(
            {"required": True}
            if declared.default is MISSING
            else {"default": declared.given(declared.default)}
        ),
        **more,
    )


def _argument(declared: Option) -> click.Argument:
    required, count = declared.default is MISSING, -1 if _is_repeated(declared) else 1
    return click.Argument([_name(declared)], type=_type(declared), nargs=count, required=required)


def _is_repeated(declared: Option) -> bool:
    return get_args(declared.annotation)[-1:] == (...,)


def _type(declared: Option) -> Any:
    """Click's type of an option, or of each of its values where it takes several."""
    kind = get_args(declared.annotation)[0] if _is_repeated(declared) else declared.annotation
    limits = {name: declared.given(limit) for name, limit in declared.range.limits.items()}
    if declared.type is not None:
        return declared.type
    if declared.choices:
        return click.Choice(declared.choices)
    if Path in (kind, *get_args(kind)):
        return File
    if get_origin(kind) is tuple:
        return Numbers(len(get_args(kind)))
    if get_origin(kind) is Sequence:
        return Numbers(low=limits["above"])
    if kind is int and limits:
        return click.IntRange(limits.get("low"), limits.get("high"))
    return Number(Range(**limits)) if kind is float else kind


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


class Number(click.ParamType):
    """A finite number in a range."""

    name = "number"

    def __init__(self, allowed: Range) -> None:
        self.allowed = allowed

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> float:
        try:
            number = float(value)
        except (TypeError, ValueError):
            # NaN lies in no range, so that one sentence refuses both.
            number = float("nan")
        if not self.allowed.holds(number):
            self.fail(f"{value!r} must be a number {self.allowed}.", param, context)
        return number


class Numbers(click.ParamType):
    """`0.25,0.025,1.6` as numbers above `low`, all different or so many as `size` says."""

    name = "number,..."

    def __init__(self, size: int | None = None, low: float = 0.0) -> None:
        self.size, self.low = size, low

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        # A default.
        if not isinstance(value, str):
            return value
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


class Pair(click.ParamType):
    """`E_GPa=Steifigkeit` as two words, each without blanks around it; or as a word and a path."""

    def __init__(self, name: str, example: str = "", kind: type = Path) -> None:
        self.name, self.example, self.kind = name, example or name, kind

    def convert(self, value: Any, param: click.Parameter | None, context: click.Context | None) -> Any:
        left, _, right = (part.strip() for part in value.partition("="))
        if not left or not right:
            self.fail(f"{value!r} is not of the form {self.example}.", param, context)
        return left, self.kind(right)


output = click.option("--output", required=True, type=File, help="File to write.")
OUTPUT = option("File to write.")
OUTPUTS = option("File to write, one for each.", key="output")
GEOMETRY = option("Trapezoidal specimen.", type=Geometry())
CYCLES = option(
    "Number of whole cycles used, at the end of a record; else those of the last 10 s.", None, low=1
)
MEASURED_IN = option(
    "Test that gave the moduli (2PB, axial, 4PB, IT-CY); else what the files say. Leave out for others.",
    None,
    choices=list(ALL_KINDS),
)
ONLY_MIX = option("The only mix to read of tables with a column of mixes.", None)
SHEET = option("The only sheet of a workbook to read; else all that hold tests.", None)
COLUMNS = option(
    "What a column holds, if its name does not say.",
    (),
    key="column",
    type=Pair("quantity_unit=column", "E_GPa=column", str),
)
