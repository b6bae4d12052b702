"""The catalogue of causes: modules with classes of them, found by importing this package."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module

from asphalt_nscd.diagnosis.causes._cause import Cause

for _module in pkgutil.iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")


def _kinds(of: type[Cause]) -> Iterator[type[Cause]]:
    for kind in of.__subclasses__():
        yield from _kinds(kind)
        if hasattr(kind, "name"):
            yield kind


EVERY: tuple[Cause, ...] = tuple(sorted((kind() for kind in _kinds(Cause)), key=lambda c: c.name))
"""All that the search looks for."""
CATALOGUE: tuple[Cause, ...] = tuple(cause for cause in EVERY if not cause.told)
"""Causes that get a rung of the ladder; the others are told with their place."""
