"""Arguments of steps that draw figures and make tables: which one, and from what."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from inspect import signature
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

from asphalt_nscd.cli._options import Pair, option
from asphalt_nscd.files.errors import InputError

Pairs = tuple[tuple[str, Path], ...]
PAIRS: Any = option("", (), type=Pair("kind=path"))


def made_from(data: Iterable[tuple[str, Path]], make: Callable[..., Any]) -> Any:
    """What `make` returns for all paths by their kind; refuses kinds that it does not take, and the lack of one."""
    kinds: dict[str, list[Path]] = {}
    for kind, path in data:
        kinds.setdefault(kind, []).append(path)
    wanted = signature(make).parameters
    unknown = [kind for kind in kinds if kind not in wanted]
    missing = [kind for kind, rule in wanted.items() if rule.default is rule.empty and kind not in kinds]
    for problem, names in (("not known", unknown), ("missing", missing)):
        if names:
            raise InputError(f"data {', '.join(names)}: {problem}; give {', '.join(wanted)} as kind=path.")
    return make(**kinds)


def part(package: str, name: str) -> ModuleType:
    """Module `name` of a package: of the figures, say."""
    names = sorted(module.name for module in iter_modules(import_module(f"asphalt_nscd.{package}").__path__))
    if name not in names:
        raise InputError(
            f"{name!r} is not among the {package.rpartition('.')[2]}; give one of {', '.join(names)}."
        )
    return import_module(f"asphalt_nscd.{package}.{name}")
