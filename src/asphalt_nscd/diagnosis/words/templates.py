"""Templates of this folder: an item ends with a pilcrow, and may be broken into lines anywhere."""

from __future__ import annotations

from functools import cache

from jinja2 import Environment, PackageLoader, StrictUndefined

from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.files.words import capital, joined, specimen_named, three_digits

END = "¶"


@cache
def environment() -> Environment:
    """Of text, with the forms of `sentences` as filters."""
    made = Environment(
        loader=PackageLoader("asphalt_nscd.diagnosis", "words"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,  # noqa: S701  the page escapes it
    )
    made.filters |= {name: value for name, value in vars(sentences).items() if callable(value)}
    made.filters |= {
        "capital": capital,
        "joined": joined,
        "named": specimen_named,
        "three_digits": three_digits,
    }
    return made


def items(text: str) -> list[str]:
    """What a template made, each item in one line; empty ones are left out."""
    folded = (" ".join(item.split()) for item in text.split(END))
    return [item for item in folded if item]
