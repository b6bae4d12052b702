"""Arguments of the wrong kind are refused where they enter, in one sentence, by what the annotations say.

beartype 0.23.1 and typeguard 4.6.1 refuse `numpy.float32` where a float is asked for.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import wraps
from numbers import Integral, Real
from pathlib import Path
from reprlib import repr as short
from types import NoneType
from typing import Any, ParamSpec, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from asphalt_nscd.files.errors import InputError

P = ParamSpec("P")
R = TypeVar("R")
# By abstract classes: beartype and typeguard refuse numpy.float32 where a float is asked for.
_PLAIN: dict[str, tuple[type | tuple[type, ...], str]] = {
    "float": (Real, "a number"),
    "int": (Integral, "a whole number"),
    "str": (str, "text"),
    "Path": (Path, "a path"),
    "Mapping": (Mapping, "a mapping"),
    "None": (NoneType, ""),
}
_ROWS = (tuple, list, np.ndarray)


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Let a function refuse, with InputError, an argument that is not what its annotation says.

    BLAS has one thread while it runs: its many small products take several times as long on more.

    Parameters
    ----------
    function : callable
        Annotated. Looked at are numbers, texts, paths, mappings, tuples of them, and classes with such
        fields; not other annotations.

    Returns
    -------
    callable
        The same function, checked.

    Examples
    --------
    >>> @checked
    ... def double(frequency_Hz: float) -> float:
    ...     return 2 * frequency_Hz
    >>> double("10")
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: double: frequency_Hz = '10' (str); give a number.
    """
    signature = inspect.signature(function)

    @wraps(function)
    def entry(*arguments: P.args, **options: P.kwargs) -> R:
        for name, value in signature.bind(*arguments, **options).arguments.items():
            said = signature.parameters[name].annotation
            _require(f"{function.__name__}: {name}", value, said, inspect.unwrap(function).__globals__)
        # BLAS has no other switch at run time; one thread also gives the same digits on any number of cores.
        with threadpool_limits(1, user_api="blas"):
            return function(*arguments, **options)

    return entry


def _require(called: str, value: Any, annotation: Any, names: Mapping[str, Any]) -> None:
    """Refuse a value of no kind of its annotation; `called` names it, `names` are the globals of the function."""
    # "tuple[float, float] | None" is two kinds; what stands in brackets is one.
    kinds = re.split(r" \| (?![^\[]*\])", annotation) if isinstance(annotation, str) else ["Any"]
    known = [found for kind in kinds if (found := _kind(kind, names))]
    # One kind that is not known may be the right one: nothing is refused.
    if len(known) < len(kinds):
        return
    if not any(_fits(value, kind, names) for kind in kinds):
        words = [word for _, word in known if word]
        # Any text may be a path, so one of the two words says it.
        if "a path" in words and "text" in words:
            words.remove("text")
        raise InputError(f"{called} = {short(value)} ({type(value).__name__}); give {' or '.join(words)}.")
    if is_dataclass(value):
        inside = vars(inspect.getmodule(type(value)))
        for one in fields(value):
            _require(f"{called}.{one.name}", getattr(value, one.name), one.type, inside)


def _kind(kind: str, names: Mapping[str, Any]) -> tuple[Any, str] | None:
    """The class that an annotation without alternatives names, and how a sentence calls it; None if not known."""
    name, _, inside = kind.partition("[")
    if name in _PLAIN:
        return _PLAIN[name]
    if name == "tuple":
        parts = inside.rstrip("]").split(", ")
        wanted = "numbers" if parts[0] == "float" else "values"
        return _ROWS, wanted if parts[-1] == "..." else f"{len(parts)} {wanted}"
    first, _, second = name.partition(".")
    found = getattr(names.get(first), second, None) if second else names.get(first)
    if not isinstance(found, type) or found is Any:
        return None
    return found, f"{'an' if found.__name__[0] in 'AEIOU' else 'a'} {found.__name__}"


def _fits(value: Any, kind: str, names: Mapping[str, Any]) -> bool:
    """Whether a value is of a kind, a tuple in all its parts; not where the kind is not known."""
    found = _kind(kind, names)
    # True is a number to Python, and never meant as one.
    if found is None or isinstance(value, bool) or not isinstance(value, found[0]):
        return False
    if found[0] is not _ROWS:
        return True
    parts = kind.partition("[")[2].rstrip("]").split(", ")
    each = parts[:1] * len(value) if parts[-1] == "..." else parts
    return len(each) == len(value) and all(
        _fits(one, part, names) for one, part in zip(value, each, strict=True)
    )
