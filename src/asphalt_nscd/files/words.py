"""Words that sentences to users share."""

from __future__ import annotations

import os
from collections.abc import Sequence

ON_PAGE = "ASPHALT_NSCD_ON_PAGE"  # `serve` tells its jobs, whose user has menus and no options


def specimen_named(name: str) -> str:
    """A specimen by its name, without saying the word twice.

    >>> specimen_named("A3"), specimen_named("Specimen 1")
    ('specimen A3', 'Specimen 1')
    """
    return name if name.casefold().startswith("specimen") else f"specimen {name}"


def counted(number: int, word: str) -> str:
    """A number with its word, in the plural but for one.

    >>> counted(1, "sphere"), counted(14160, "sphere")
    ('1 sphere', '14160 spheres')
    """
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def joined(words: Sequence[str], last: str = "and") -> str:
    """Words in a list, with `last` before the last one.

    >>> joined(["a", "b", "c"]), joined(["a", "b"], "or"), joined(["a"])
    ('a, b and c', 'a or b', 'a')
    """
    return f" {last} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def capital(words: str) -> str:
    """The words with a capital first; units keep theirs."""
    return f"{words[:1].upper()}{words[1:]}"


def numbers(values: Sequence[float], last: str = "and") -> str:
    """Numbers in a list: `4, 20 and 40`."""
    return joined([f"{value:g}" for value in values], last)


def choice(option: str, menu: str) -> str:
    """What a user does to choose: give an option of the command line, or take what the page has in its place."""
    return menu if os.environ.get(ON_PAGE) else option


def three_digits(value: float) -> str:
    """A number in three digits: 1553.2 -> "1550", 0.02861 -> "0.0286"."""
    return f"{float(f'{value:.3g}'):.10g}"
