"""What a table with many kinds of data takes as one object."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, TypeVar

Data = TypeVar("Data")
Made = TypeVar("Made")


def gathered(kinds: Callable[..., Data]) -> Callable[[Callable[[Data], Made]], Callable[..., Made]]:
    """Decorator: call with the fields of the dataclass `kinds`, which the function gets as one object."""

    def decorate(make: Callable[[Data], Made]) -> Callable[..., Made]:
        @wraps(make)
        def made(**data: Any) -> Made:
            return make(kinds(**data))

        # The command line asks for the kinds of data that a table takes.
        made.__signature__ = signature(kinds)  # type: ignore[attr-defined]
        return made

    return decorate
