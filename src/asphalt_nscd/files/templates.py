"""A template of this package, and the items of a text; an item ends with a pilcrow, and may be broken anywhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from asphalt_nscd.files.words import capital, counted, joined, specimen_named, three_digits

END = "¶"
FILTERS = {
    "capital": capital,
    "counted": counted,
    "joined": joined,
    "named": specimen_named,
    "three_digits": three_digits,
}


def template(
    path: str,
    filters: Mapping[str, Callable[..., Any]] | None = None,
    variables: Mapping[str, Any] | None = None,
) -> Template:
    """The template at a path in the package; one of HTML escapes what it is filled with."""
    folder, _, name = path.rpartition("/")
    made = Environment(
        loader=PackageLoader("asphalt_nscd", folder),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=name.endswith(".html"),
    )
    made.filters |= FILTERS | dict(filters or {})
    return made.get_template(name, globals=dict(variables or {}))


def items(text: str) -> list[str]:
    """What a template made, each item in one line; empty ones are left out."""
    folded = (" ".join(item.split()) for item in text.split(END))
    return [item for item in folded if item]
