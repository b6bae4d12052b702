"""Numbers as people write them, with a decimal point or a decimal comma, but one of them throughout."""

from __future__ import annotations

import re
from collections.abc import Iterable

from asphalt_nscd.files.csvinput import plain_number
from asphalt_nscd.files.errors import InputError

_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
_POINT = re.compile(r"[-+]?\d*\.\d*([eE][-+]?\d+)?")
# Which groups its digits, and cannot be read otherwise.
_ENGLISH = re.compile(r"[-+]?\d{1,3}(?:,\d{3})+\.\d+")
# Groups are parted by comma, point, apostrophe, and blanks that do not break (U+00A0, U+202F).
_GROUPED = re.compile(r"[-+]?\d{1,3}(?:[., '\u00a0\u202f]\d{3})+(?:[.,]\d+)?")


class Number(str):
    """A cell that a workbook keeps as a number: its text, for words and headings, and `value`, the number itself."""

    value: float

    def __new__(cls, value: float) -> Number:
        """The cell of a number."""
        whole = float(value).is_integer() and abs(value) < 1e15
        # 4.2 in a heading, where the file holds 4.2000000000000002.
        cell = super().__new__(cls, str(int(value)) if whole else f"{value:.12g}")
        cell.value = float(value)
        return cell


def decimal_mark(where: str, numbers: Iterable[tuple[int, str]]) -> str:
    """The decimal mark, `,` or `.`, which must be one throughout; groups as in `1 234` are refused."""
    # The first line of each mark, for the refusal names both.
    first: dict[str, tuple[int, str]] = {}
    kept = False  # as numbers, which have no mark
    for line, text in numbers:
        kept |= isinstance(text, Number)
        if isinstance(text, Number):
            continue
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
    doubtful = next((one for one in first.values() if _GROUPED.fullmatch(one[1])), None)
    if doubtful and kept and "," in first:
        raise InputError(f"{where}, line {doubtful[0]}: {doubtful[1]!r} is text; enter it as a number.")
    if len(first) == 2:
        (comma_line, comma), (point_line, point) = first[","], first["."]
        grouped = next((text for text in (comma, point) if _GROUPED.fullmatch(text)), "")
        raise InputError(
            f"{where}: {comma!r} (line {comma_line}) and {point!r} (line {point_line}) have different decimal marks"
            + (f", or {grouped!r} groups its digits in thousands" if grouped else "")
            + f"; write all numbers with the same{' and without separators' if grouped else ''}."
        )
    return "," if "," in first else "."


def match_decimal_mark(heading: str, cells: Iterable[str]) -> str:
    """A number of a heading with the decimal mark of cells below it, where one of them can mean nothing else."""
    comma = any(_COMMA.fullmatch(cell) and not _GROUPED.fullmatch(cell) for cell in cells)
    return heading.replace(".", ",") if comma else heading


def number(cell: str, mark: str = "") -> float | None:
    """The number that a cell holds, with this decimal mark or, without one, with either; None if it holds none."""
    if isinstance(cell, Number):
        return cell.value
    if mark == "." and _ENGLISH.fullmatch(cell):
        cell = cell.replace(",", "")
    try:
        return plain_number(cell if mark == "." else cell.replace(",", ".").replace("−", "-"))
    except ValueError:
        return None
