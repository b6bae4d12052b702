"""Numbers as people write them, with a decimal point or a decimal comma, but one of them throughout."""

from __future__ import annotations

import re
from collections.abc import Iterable

from asphalt_nscd.files.csvinput import plain_number
from asphalt_nscd.files.errors import InputError

_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
_POINT = re.compile(r"[-+]?\d*\.\d*([eE][-+]?\d+)?")
_ENGLISH = re.compile(
    r"[-+]?\d{1,3}(?:,\d{3})+\.\d+"
)  # which groups its digits, and cannot be read otherwise
# Groups are parted by comma, point, apostrophe, and blanks that do not break (U+00A0, U+202F).
_GROUPED = re.compile(r"[-+]?\d{1,3}(?:[., '\u00a0\u202f]\d{3})+(?:[.,]\d+)?")


def decimal_mark(where: str, numbers: Iterable[tuple[int, str]]) -> str:
    """The decimal mark, `,` or `.`, which must be one throughout; groups as in `1 234` are refused."""
    # The first line of each mark, for the refusal names both.
    first: dict[str, tuple[int, str]] = {}
    for line, text in numbers:
        if _ENGLISH.fullmatch(text):
            first.setdefault(".", (line, text))
            continue
        # One mark before three digits, `9,100`, may be decimal: only the other numbers of the table tell.
        marks = sum(text.count(mark) for mark in "., '\u00a0\u202f")
        if (marks > 1 or re.search(r"[ '\u00a0\u202f]", text)) and _GROUPED.fullmatch(text):
            raise InputError(
                f"{where}, line {line}: {text!r} seems to group its digits in thousands; write it without separators."
            )
        for mark, pattern in ((",", _COMMA), (".", _POINT)):
            if pattern.fullmatch(text):
                first.setdefault(mark, (line, text))
    if len(first) == 2:
        (comma_line, comma), (point_line, point) = first[","], first["."]
        # A workbook keeps numbers without a mark; what has one was typed as text.
        if ".xls" in where.casefold():
            raise InputError(f"{where}, line {comma_line}: {comma!r} is text; enter it as a number.")
        raise InputError(
            f"{where}: {comma!r} (line {comma_line}) and {point!r} (line {point_line}) have different decimal "
            f"marks{_groups_note(comma, point)}; write all numbers with the same{_ungrouped(comma, point)}."
        )
    return "," if "," in first else "."


def match_decimal_mark(heading: str, cells: Iterable[str]) -> str:
    """A number of a heading with the decimal mark of cells below it, where one of them can mean nothing else."""
    comma = any(_COMMA.fullmatch(cell) and not _GROUPED.fullmatch(cell) for cell in cells)
    return heading.replace(".", ",") if comma else heading


def _groups_note(*texts: str) -> str:
    grouped = next((text for text in texts if _GROUPED.fullmatch(text)), None)
    return f", or {grouped!r} groups its digits in thousands" if grouped else ""


def _ungrouped(*texts: str) -> str:
    return " and without separators" if _groups_note(*texts) else ""


def normalise_decimal(text: str, mark: str) -> str:
    """A number with a decimal point and without groups, `5,558.0` as `5558.0`; other text as it is."""
    if mark == ",":
        return text.replace(",", ".")
    return text.replace(",", "") if _ENGLISH.fullmatch(text) else text


def number(text: str, mark: str) -> float | None:
    """The number that a cell holds, read with the decimal mark `mark`; None if it holds none."""
    try:
        return plain_number(normalise_decimal(text, mark))
    except ValueError:
        return None
