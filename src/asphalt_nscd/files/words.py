"""Words that sentences to users share."""

from __future__ import annotations


def counted(number: int, word: str) -> str:
    """A number with its word, in the plural but for one.

    >>> counted(1, "sphere"), counted(14160, "sphere")
    ('1 sphere', '14160 spheres')
    """
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
