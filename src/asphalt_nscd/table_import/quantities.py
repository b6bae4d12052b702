"""What a column name says: `|E*| [GPa]`, `phi (deg)`, `delta_rad`, `Temp °C`, `z0 (µm)`, `f / Hz`."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.units import MEGAPASCAL
from asphalt_nscd.table_import.words import SAY, WORDS

# Spellings as `_spelled` leaves them: factor and offset that lead to the unit of our tables.
_UNITS_OF: dict[str, dict[str, tuple[float, float]]] = {
    "temperature": {"C": (1.0, 0.0), "K": (1.0, -273.15), "F": (5 / 9, -160 / 9)},
    "frequency": {"Hz": (1.0, 0.0), "rad/s": (0.5 / math.pi, 0.0)},
    "modulus": {unit: (factor, 0.0) for unit, factor in MEGAPASCAL.items()},
    "angle": {"deg": (1.0, 0.0), "rad": (180 / math.pi, 0.0), "mrad": (0.18 / math.pi, 0.0)},
    "force": {"N": (1.0, 0.0), "kN": (1e3, 0.0)},
    "length": {"m": (1.0, 0.0), "mm": (1e-3, 0.0), "um": (1e-6, 0.0)},
    "sieve": {"m": (1e3, 0.0), "mm": (1.0, 0.0), "um": (1e-3, 0.0)},
    "percent": {"%": (1.0, 0.0), "percent": (1.0, 0.0)},
    "share": dict.fromkeys(("", "%", "percent"), (1.0, 0.0)),  # voids: a column that says no unit has percent
    "time": {"s": (1.0, 0.0)},
    "ratio": dict.fromkeys(("", "-", "1"), (1.0, 0.0)),
    "number": {"": (1.0, 0.0)},
    "": {},
}
Known = dict[str, tuple[str, dict[str, tuple[float, float]]]]


def _known(quantities: dict[str, dict[str, str]]) -> Known:
    """Names that people give each of our columns, and the units that it may have."""
    return {name: (one.get("names", ""), _UNITS_OF[one.get("kind", "")]) for name, one in quantities.items()}


MEASURED, SIEVES = _known(WORDS["quantity"]), _known(WORDS["sieve"])
QUALITY = tuple(name for name in MEASURED if re.search("drift|standard_error|uniformity", name))
LONGEST_NAME = 200  # characters; what is longer names no column, and would be searched for long
_BESIDE = frozenset(SAY["nothing"])  # words that a name may carry beside that of its quantity
_SPELLINGS = {word: unit for unit, words in WORDS["unit"].items() for word in words.split()}
_PRIMES = str.maketrans({**dict.fromkeys("’′´", "'"), **dict.fromkeys("”″", '"')})
_PART = re.compile(r"E[\s_]*(1|2|'|''|\")")  # of E*, in French and in English
_UNITS = {name for _, units in (MEASURED | SIEVES).values() for name in units}


@dataclass(frozen=True)
class Meaning:
    """What a heading says that its column holds: number * factor + offset in our unit.

    `quantity` is our column; `unit` is as the header says it: empty for text, None where the header says none.
    """

    quantity: str
    unit: str | None
    factor: float = 1.0
    offset: float = 0.0

    @property
    def converts(self) -> bool:
        """Whether the unit is another than ours."""
        return (self.factor, self.offset) != (1.0, 0.0)


def recognise(header: str, known: dict = MEASURED) -> Meaning | None:
    """The column that a name stands for; None if it is none of those known. Refuses another quantity's unit."""
    if len(header) > LONGEST_NAME:
        return None
    if header in known:  # one of ours
        units = known[header][1]
        return Meaning(
            header, header.rpartition("_")[2] if units and units is not _UNITS_OF["number"] else ""
        )
    header = re.sub(r"\btan\s*[(\[]([^)\]]*)[)\]]", r"tan \1", header)  # no unit stands in these brackets
    foreign = None
    for stem, unit in _splits(header):
        quantity = _quantity(stem, known, qualified=unit in _UNITS_OF["temperature"])
        if quantity is None:
            continue
        units = known[quantity][1]
        if not units and not unit:
            return Meaning(quantity, "")
        if unit in units:
            return Meaning(quantity, unit, *units[unit])
        if units and not unit:
            return Meaning(quantity, None)
        # Refused only after all ways to read the name: another may give a unit that the quantity has.
        foreign = foreign or (quantity, unit)
    if foreign:
        quantity, unit = foreign
        written = re.search(r"[(\[{]([^)\]}]*)[)\]}]$", header)
        unit = written[1] if written else unit
        allowed = ", ".join(filter(None, known[quantity][1]))
        mend = f"give one of {allowed}" if allowed else "write what stands in brackets without them"
        raise InputError(f"column {header!r}: {unit!r} is not a unit of {quantity}; {mend}.")
    return None


def derived(header: str) -> str:
    """What a column holds in place of a measured quantity: "logarithm", "reduced" to one temperature, else empty."""
    if re.match(r"\W*(?:log|lg|ln)(?:10)?(?![a-z])", header, re.IGNORECASE):
        return "logarithm"
    return "reduced" if any(word in header.casefold() for word in SAY["reduced"]) else ""


def spellings(known: dict = MEASURED) -> str:
    """A line for each column: its name, those that people give it, and the units understood."""
    return "\n".join(
        f"{quantity}: {', '.join(names.split() or [quantity])}" + (f" [{', '.join(units)}]" if units else "")
        for quantity, (names, units) in known.items()
    )


def unit_in(header: str) -> str | None:
    """The unit that a name carries, whatever it names; None if none that is known."""
    return next((unit for _, unit in _splits(header) if unit and unit in _UNITS), None)


def units_in(header: str) -> list[str]:
    """All units in a name, wherever they stand, but those of plain numbers."""
    parts = (_spelled(part) for part in re.split(r"[\s,;()\[\]]+", header))
    return [unit for unit in parts if unit in _UNITS and unit not in ("", "-", "1", "%")]


def is_unit(cell: str) -> bool:
    """Whether a cell holds nothing but a unit, as in a second line below the names."""
    return _spelled(cell.strip("()[]{} ")) in _UNITS


def _splits(header: str) -> Iterator[tuple[str, str]]:
    """Ways to read a name as quantity and unit, the likeliest first."""
    bracketed = re.fullmatch(r"(.*?)[\s_]*[(\[{]([^)\]}]*)[)\]}]", header)
    if bracketed:
        # What stands in brackets is meant as a unit, known or not; any other ending must be a unit that we know.
        yield bracketed[1], _spelled(bracketed[2])
        return
    parted = re.fullmatch(r"(.*\S)\s*/\s*(\S+)", header)
    for match in (
        re.fullmatch(r"(.+?)\s*,\s*([^,]+)", header),
        re.fullmatch(r"(.+?)\s+(?:in|en|em)\s+(\S+)", header),
        re.fullmatch(r"(.+?)\s*[\s_]\s*(\S+)", header),
        re.fullmatch(r"(.*\S)\s*([°º]\s*[CF])", header),
        parted,
    ):
        if match and _spelled(match[2]) in _UNITS:
            yield match[1], _spelled(match[2])
    if re.match(r"\s*%", header):
        yield header.replace("%", ""), "%"
    yield header, ""


def _spelled(unit: str) -> str:
    """A unit in one of the spellings that stand in the tables above."""
    # The micro sign and the Greek mu look alike, and both are in use.
    unit = re.sub(r"\s+", "", unit).replace("µ", "u").replace("μ", "u").replace("²", "2").replace("^", "")
    unit = unit.rstrip(".")
    unit = re.sub(
        r"^(?:[°º]|deg\.?|degrees?|degrés?|grad)(?=(?:[CKF]|celsius|fahrenheit)$)", "", unit, flags=re.I
    )
    if unit in _SPELLINGS:
        return _SPELLINGS[unit]
    if len(unit) < 2 or re.match("m[A-Z]", unit):  # mPa and mN stay what they are
        return unit
    return _SPELLINGS.get(unit.lower()) or next((one for one in _UNITS if one.lower() == unit.lower()), unit)


def _quantity(stem: str, known: dict, qualified: bool) -> str | None:
    """Our column for a name without its unit; None if no column or several fit.

    `qualified`: a temperature may carry a further word, as in `T set` beside `T core`.
    """
    alone = _named(stem, known, qualified)
    if alone:
        return alone
    words = [word for word in re.split(r"[\s_/-]+|(?<=\bd)['’]|(?<=\bl)['’]", stem) if word]
    # `E* D` and `E* E` are of specimens D and E: a capital letter alone is no article, and E no second name.
    words = [word for word in words if word in ("D", "L") or _folded(word.strip(".:°º")) not in _BESIDE]
    if words in (["E*", "E"], ["|E*|", "E"]):
        return None
    # As in `Dynamic modulus |E*|` or `Fréquence / Frequency`, where each part names it: up to each word, by what.
    named: list[set[str]] = [set(known)]
    for end in range(1, len(words) + 1):
        parts = ((start, _named(" ".join(words[start:end]), known, qualified)) for start in range(end))
        named.append({quantity for start, quantity in parts if quantity in named[start]})
    return next(iter(named[-1])) if words and len(named[-1]) == 1 else None


def _named(stem: str, known: dict, qualified: bool) -> str | None:
    """Our column for words that name one alone; None if none does."""
    if known is MEASURED and (part := _PART.fullmatch(stem.translate(_PRIMES))):
        return "E1_MPa" if part[1] in ("1", "'") else "E2_MPa"
    if qualified:
        stem = stem.rstrip(" °º") or stem  # `T° (°C)`
    plain = re.sub(r"[|*.\s_()\[\]-]", "", stem)
    words = [_folded(word) if len(word) > 1 else word for word in re.split(r"[\s_.-]+", stem)]
    by_name = _BY_NAME[id(known)]
    quantity = by_name.get(plain if len(plain) == 1 else _folded(plain))
    if quantity is None and qualified and any(by_name.get(word) == "temperature_C" for word in words):
        return "temperature_C"
    return quantity


@lru_cache(maxsize=4096)
def _folded(text: str) -> str:
    """Small letters without accents; an umlaut may be written with an e."""
    plain = "".join(c for c in unicodedata.normalize("NFKD", text.casefold()) if not unicodedata.combining(c))
    return re.sub("(?<=[aou])e", "", plain)


def _names(known: dict) -> dict[str, str]:
    """Quantity of each name, the first of two; names of more than one letter folded."""
    found: dict[str, str] = {}
    for quantity, (names, _) in known.items():
        for name in names.split():
            found.setdefault(name if len(name) == 1 else _folded(name), quantity)
    return found


# Every cell of a file is asked whether it is a name. A dict has no hash, so that they stand by the table's identity.
_BY_NAME = {id(known): _names(known) for known in (MEASURED, SIEVES)}
