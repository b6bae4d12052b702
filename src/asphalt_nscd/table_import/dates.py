"""Which of two tests came later, from dates as machines and people write them: `Sat, Dec 7, 2019, 10:25 AM`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date, time

# `dateutil` refuses `7. Dez. 2019` and `7 déc 2019`, reads `07.12.2019` as 12 July, and never says that day and month
# may be exchanged.
_MONTHS = {
    name: number
    for number, names in enumerate(
        (
            "jan",
            "feb fév fev",
            "mar mär mrz",
            "apr avr",
            "may mai",
            "jun juin",
            "jul juil",
            "aug aoû aou",
            "sep",
            "oct okt",
            "nov",
            "dec dez déc",
        ),
        start=1,
    )
    for name in names.split()
}
_WORD = "(" + "|".join(sorted(_MONTHS, key=len, reverse=True)) + r")[a-zûé]*\.?"
_CLOCK = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2}))?(?:\.\d+)?\s*([ap])?\.?m?", re.IGNORECASE)


@dataclass(frozen=True)
class _Moment:
    """A day, read with the month first and with the day first (the same where it is not ambiguous), and the time."""

    month_first: date | None
    day_first: date | None
    clock: time | None


def later(first: str, second: str) -> bool | None:
    """Whether the second of two dates is after the first; None if they do not tell."""
    a, b = _moment(first), _moment(second)
    if a is None or b is None:
        return None
    said: set[bool | None] = set()
    for one, other in ((a.month_first, b.month_first), (a.day_first, b.day_first)):
        if one is None or other is None:
            continue
        if one != other:
            said.add(other > one)
        elif a.clock and b.clock and a.clock != b.clock:
            said.add(b.clock > a.clock)
        else:
            said.add(None)
    # 03/04/2019 may be read in two ways: an order counts only if both give it.
    return said.pop() if len(said) == 1 else None


def _moment(text: str) -> _Moment | None:
    text = text.casefold()
    clock = _CLOCK.search(text)
    at = _time(clock) if clock else None
    text = text if clock is None else text[: clock.start()] + " " + text[clock.end() :]
    if found := re.search(r"\b(\d{4})[-/.](\d{1,2})[-/.](\d{1,2})", text):
        day = _date(found[1], found[2], found[3])
        return _Moment(day, day, at) if day else None
    if found := re.search(_WORD + r"\s*(\d{1,2})(?:st|nd|rd|th)?,?\s+(\d{4})", text):
        day = _date(found[3], str(_MONTHS[found[1]]), found[2])
        return _Moment(day, day, at) if day else None
    if found := re.search(r"\b(\d{1,2})(?:st|nd|rd|th)?\.?[\s-]*" + _WORD + r"[\s,-]*(\d{4}|\d{2})\b", text):
        day = _date(found[3], str(_MONTHS[found[2]]), found[1])
        return _Moment(day, day, at) if day else None
    if found := re.search(r"\b(\d{1,2})([-/.])(\d{1,2})\2(\d{4}|\d{2})\b", text):
        day_first = _date(found[4], found[3], found[1])
        # Between points, as in German, the day comes first.
        month_first = _date(found[4], found[1], found[3]) if found[2] != "." else day_first
        if day_first or month_first:
            return _Moment(month_first, day_first, at)
    return None


def _date(year: str, month: str, day: str) -> date | None:
    try:
        return date(int(year) + (2000 if len(year) == 2 else 0), int(month), int(day))
    except ValueError:
        return None


def _time(found: re.Match[str]) -> time | None:
    hour = int(found[1])
    if found[4]:
        # 12 am is midnight, 12 pm noon.
        hour = hour % 12 + (12 if found[4] == "p" else 0)
    try:
        return time(hour, int(found[2]), int(found[3] or 0))
    except ValueError:
        return None
