"""The specimen's own name in what an operator typed for one test: `Mix-10-21C-Repeated (4G16013A)` is `Mix-10`."""

from __future__ import annotations

import re
from dataclasses import dataclass

from asphalt_nscd.measurements.units import celsius_of_fahrenheit

_TEMPERATURE = re.compile(  # not the grade of a binder, `PG64-28C`
    r"(?<!PG\d\d)(?<!PG \d\d)(?:[-_ ,]+?(?=[-−]\d)|([-_ ,]+)|(?=−))([-−]?\d+(?:[.,]\d+)?)"
    r"\s*(?:[°º]\s*|deg\s*)?([CF])(?![A-Za-z0-9])"
)
_REPEATED = re.compile(
    r"[-_ ]*(?<![^\W_])(?:repeat(?:ed)?|rerun|re-?test(?:ed)?|redo(?:ne)?)(?![^\W\d_])[-_ \d]*$",
    re.IGNORECASE,
)
_SAME = 1.0  # K between a temperature in a name and the target it means


@dataclass(frozen=True)
class Name:
    """What an operator typed for one test: the specimen's own name and what else stood in it.

    `temperature` [degC] is text. `repeated`: a remark says so. `contradicts`: the header has another temperature.
    `hyphened`: a single hyphen stands before the temperature, which may be a minus.
    """

    specimen: str
    temperature: str | None
    repeated: bool
    contradicts: bool
    hyphened: bool = False


def specimen_of(text: str, target: float | None) -> Name:
    """Name of the specimen without temperature and remarks, and what they say; `target` [degC] is of the header."""
    plain = re.sub(r"\s*[(\[][^)\]]*[)\]]\s*$", "", text).strip()
    found = list(_TEMPERATURE.finditer(plain))
    # The one that the header names, else the last: `PG64-22C` may stand before it.
    same = [match for match in found if target is not None and _is(match, target)]
    match = (same or found)[-1] if found else None
    tail = plain if match is None else plain[match.end() :]
    repeated = _REPEATED.search(tail) is not None
    stem = plain if match is None else plain[: match.start()]
    # A name that is all remark, `Repeated`, stays a name.
    stem = _REPEATED.sub("", stem).strip("-_ ,") or plain
    temperature = None if match is None else f"{_degrees(match):.4g}"
    hyphened = match is not None and match[1] == "-"
    return Name(stem, temperature, repeated, bool(match and target is not None and not same), hyphened)


def _is(match: re.Match[str], target: float) -> bool:
    """Whether a temperature means the target; a name may lack the minus, but one that has it means it."""
    value = _degrees(match)
    apart = abs(value - target)
    return (apart if value < 0.0 else min(apart, abs(value - abs(target)))) <= _SAME


def file_label(stem: str) -> str:
    """What an export's file is called, without the machine's mark of a summary."""
    return re.sub(r"[_\s-]*Sum(mary)?$", "", stem, flags=re.IGNORECASE)


def one_of_another(first: str, second: str) -> bool:
    """Whether two names are of two specimens of one series: `Mix-B` and `Mix-C`, `K10` and `K11`."""
    return spelling(first) != spelling(second) and _series(first) == _series(second)


def spelling(name: str) -> str:
    """A name to compare, without what people vary: capitals, blanks, hyphens."""
    return re.sub(r"[\W_]+", "-", name.casefold())


def _series(name: str) -> str:
    return re.sub(r"\d+|\b[^\W\d_]\b", "#", spelling(name))


def _degrees(match: re.Match[str]) -> float:
    return celsius(match[2].replace("−", "-"), match[3])


def celsius(text: str, unit: str) -> float:
    """A temperature in degC, from text in the unit "C", "F" or "K"."""
    value = float(text.replace(",", "."))
    return {"C": value, "F": celsius_of_fahrenheit(value), "K": value - 273.15}[unit]
