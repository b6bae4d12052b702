"""Which of two tests came later, from dates as machines and people write them: `Sat, Dec 7, 2019, 10:25 AM`."""

from __future__ import annotations

import re
from datetime import datetime

from dateutil.parser import parse, parserinfo

from asphalt_nscd.table_import.words import WORDS


class _Words(parserinfo):
    """Months in the languages of `words.toml`."""

    MONTHS = [tuple(names.split()) for names in WORDS["month"]]


def later(first: str, second: str) -> bool | None:
    """Whether the second of two dates is after the first; None if they do not tell."""
    told: set[bool | None] = set()
    # 03/04/2019 may be read in two ways: an order counts only if both give it.
    for day_first in (False, True):
        (a, a_clock), (b, b_clock) = (_moment(text, day_first) for text in (first, second))
        if a is None or b is None:
            continue
        if a.date() != b.date():
            told.add(b > a)
        else:
            told.add(b > a if a_clock and b_clock and a != b else None)
    return told.pop() if len(told) == 1 else None


def _moment(text: str, day_first: bool) -> tuple[datetime | None, bool]:
    """A date, read with the day or the month first where both can be, and whether it has a time of day."""
    # Between points, as in German, the day comes first; behind a year the month does.
    day_first = (day_first or bool(re.search(r"\d\.\d+\.\d", text))) and not re.search(r"\d{4}[-/.]\d", text)
    try:
        # What the text lacks differs between the two.
        one, other = (parse(text, _Words(day_first), default=datetime(n, n, n, n)) for n in (1, 2))
    except (ValueError, OverflowError):
        return None, False
    return (one if one.date() == other.date() else None), one.time() == other.time()
