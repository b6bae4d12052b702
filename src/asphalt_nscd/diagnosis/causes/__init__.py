"""The catalogue of causes: one module with one class each, found by importing this package."""

from __future__ import annotations

import pkgutil
from importlib import import_module

from asphalt_nscd.diagnosis.causes._cause import Cause

for _module in pkgutil.iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

CATALOGUE: tuple[Cause, ...] = tuple(
    sorted((cause() for cause in Cause.__subclasses__()), key=lambda c: c.name)
)
