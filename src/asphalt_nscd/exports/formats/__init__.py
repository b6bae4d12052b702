"""Formats of other programs: one module each, found by its name. It has ENDINGS of its files, the usual one first, and
`write(law, settings, path)`, which returns a line on what was written.
"""

from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

FORMATS = tuple(module.name for module in iter_modules(__path__))  # importing none, for the command line asks


def format_of(name: str) -> ModuleType:
    """The module that writes a format of FORMATS."""
    return import_module(f"{__name__}.{name}")
