"""Options: help, default, range and unit stand once. The command line and the schema of a study are made from them.

A study starts hundreds of jobs. Beside click a start takes 8 ms more with msgspec 0.22, which makes no commands, 42 ms
with cyclopts, 70 ms with pydantic 2.14.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import MISSING, field, fields
from functools import cache
from inspect import getdoc
from numbers import Real
from types import NoneType
from typing import Any, NamedTuple, get_args, get_type_hints

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range

_DESCRIBED = re.compile(r"^(\w+) : .*\n((?:    .+(?:\n|$))+)", re.MULTILINE)  # a parameter, in numpydoc form

hints_of = cache(get_type_hints)


class Option(NamedTuple):
    """What is stated of a value that a user gives.

    `key` names it in a study and, in lower case, at the command line, there in `unit` of the field: 1e-3 for mm of m.
    `name` is how Python's sentences call it. `type` is that of click, where the annotation does not say it.
    """

    help: str
    key: str
    name: str
    default: Any
    annotation: Any
    unit: float
    range: Range
    choices: Sequence[str]
    type: Any

    def given(self, value: Any) -> Any:
        """A value of the field in the unit of the key."""
        return value if self.unit == 1.0 or value is None or value is MISSING else value / self.unit

    def stored(self, value: Any) -> Any:
        """A value in the unit of the key as the field has it."""
        return value if self.unit == 1.0 or value is None else value * self.unit


def option(help: str = "", default: Any = MISSING, **more: Any) -> Any:
    """A field of a dataclass, or a parameter of a command, that is an option.

    more: `key`, `name`, `unit`, `choices`, `type`, `range` of `Option`, or the limits of a range. Without a default it
    must be given; without help the docstring of its class, in numpydoc form, gives it.
    """
    limits = {name: more.pop(name) for name in ("above", "low", "below", "high") if name in more}
    return field(default=default, metadata={"help": help, "range": Range(**limits), **more})


def option_of(name: str, made: Any, annotation: Any) -> Option:
    """The option that `option` made of a field or parameter; None is left out of its annotation."""
    declared = {"key": name, "unit": 1.0, "choices": (), "type": None, **made.metadata}
    kinds = [kind for kind in get_args(annotation) if kind is not NoneType]
    plain = kinds[0] if len(kinds) == 1 and NoneType in get_args(annotation) else annotation
    return Option(**{"name": declared["key"], **declared}, default=made.default, annotation=plain)


@cache
def options_of(kind: Any) -> dict[str, Option]:
    """Options of a dataclass by the names of their fields.

    >>> from asphalt_nscd.specimen.settings import Vibration
    >>> declared = options_of(Vibration)["frequency"]
    >>> declared.key, declared.default, str(declared.range), declared.help
    ('vibration_Hz', 30.0, 'greater than 0 and at most 1000', 'Frequency of the top wall, Hz.')
    """
    hints, described = hints_of(kind), dict(_DESCRIBED.findall(getdoc(kind) or ""))
    made = {
        where.name: option_of(where.name, where, hints[where.name])
        for where in fields(kind)
        if "help" in where.metadata
    }
    return {
        name: declared._replace(help=declared.help or " ".join(described.get(name, "").split()))
        for name, declared in made.items()
    }


class Ranged:
    """A dataclass that refuses values out of the ranges of its options, in one sentence.

    >>> from asphalt_nscd.specimen.settings import Vibration
    >>> Vibration(duration=-1.0)
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: vibration: duration_s = -1; give a number at least 0 and at most 60.
    """

    def __post_init__(self) -> None:
        kind: Any = type(self)
        for name, declared in options_of(kind).items():
            value, called = getattr(self, name), f"{type(self).__name__.lower()}: {declared.name}"
            if declared.range.limits and isinstance(value, Real) and not declared.range.holds(float(value)):
                raise InputError(f"{called} = {float(value):g}; give a number {declared.range}.")
            if declared.choices and isinstance(value, str) and value not in declared.choices:
                raise InputError(
                    f"{called} = {value!r} is not known; give one of {', '.join(declared.choices)}."
                )
