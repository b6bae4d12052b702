"""Ranges of numbers, stated at the fields of the dataclasses that the command line and Python share."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import Field, dataclass, field, fields
from numbers import Real
from typing import Any, TypeVar

from asphalt_nscd.files.errors import InputError

T = TypeVar("T")


@dataclass(frozen=True)
class Range:
    """Finite numbers between limits; `above` and `below` are excluded, `low` and `high` included.

    >>> str(Range(above=0.0, high=60.0)), Range(above=0.0).holds(float("inf"))
    ('greater than 0 and at most 60', False)
    """

    above: float = -math.inf
    low: float = -math.inf
    below: float = math.inf
    high: float = math.inf

    def holds(self, number: float) -> bool:
        """Whether a number is one of them; False for what is not finite."""
        return math.isfinite(number) and self.above < number < self.below and self.low <= number <= self.high

    def __str__(self) -> str:
        limits = {
            "greater than": self.above,
            "at least": self.low,
            "less than": self.below,
            "at most": self.high,
        }
        said = [f"{words} {limit:g}" for words, limit in limits.items() if math.isfinite(limit)]
        return " and ".join(said) or "finite"


def within(default: T, name: str = "", **limits: float) -> T:
    """A field of a class that inherits `Ranged`, whose values are in a `Range` with these limits.

    `name` is how a sentence calls it, with its unit; else that of the field.
    """
    made: Any = field(default=default, metadata={"name": name, "range": Range(**limits)})
    return made


def one_of(default: T, choices: Sequence[T]) -> T:
    """A field of a class that inherits `Ranged`, whose value is one of some."""
    made: Any = field(default=default, metadata={"choices": choices})
    return made


class Ranged:
    """A dataclass that refuses values out of the ranges of its fields, in one sentence.

    >>> @dataclass(frozen=True)
    ... class Vibration(Ranged):
    ...     duration: float = within(1.0, "duration_s", low=0.0, high=60.0)
    >>> Vibration(duration=-1.0)
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: vibration: duration_s = -1; give a number at least 0 and at most 60.
    """

    def __post_init__(self) -> None:
        for one in fields(self):  # type: ignore[arg-type]  # of the dataclass that inherits
            self._require(one, getattr(self, one.name))

    def _require(self, one: Field[Any], value: Any) -> None:
        called = f"{type(self).__name__.lower()}: {one.metadata.get('name') or one.name}"
        allowed: Range | None = one.metadata.get("range")
        if allowed and isinstance(value, Real) and not allowed.holds(float(value)):
            raise InputError(f"{called} = {float(value):g}; give a number {allowed}.")
        choices = one.metadata.get("choices")
        if choices and isinstance(value, str) and value not in choices:
            raise InputError(f"{called} = {value!r} is not known; give one of {', '.join(choices)}.")
