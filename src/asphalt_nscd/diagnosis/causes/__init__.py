"""The catalogue of causes: one module with one class each, found by importing this package, and faults of one place."""

from __future__ import annotations

import pkgutil
from importlib import import_module

from asphalt_nscd.diagnosis.causes._cause import Cause
from asphalt_nscd.diagnosis.causes.one_place import OF_ONE_PLACE

for _module in pkgutil.iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

CATALOGUE: tuple[Cause, ...] = tuple(
    sorted((kind() for kind in Cause.__subclasses__() if not kind.told), key=lambda c: c.name)
)
"""Causes that get a rung of the ladder."""
EVERY: tuple[Cause, ...] = (*CATALOGUE, *OF_ONE_PLACE)
"""All that the search looks for: these are told with their place."""
