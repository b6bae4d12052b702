"""What one heading says: quantity, unit, and the temperature, frequency or specimen that its column is for.

`|E*| (MPa) at 4 °C`, `E* 2 (MPa)`, `phi (deg) 10 Hz`, `Spec. 1`, `T = 21 °C`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.quantities import LONGEST_NAME, Meaning, recognise
from asphalt_nscd.table_import.words import MEAN as MEAN_WORD
from asphalt_nscd.table_import.words import SAY, SPREAD

SPECIMEN, CELSIUS, FAHRENHEIT, HERTZ = "specimen", "T (°C)", "T (°F)", "f (Hz)"
MEAN = "Mean"  # in place of a specimen
TEMPERATURES = ("temperature_C", "nominal_temperature_C")
KEYS = (*TEMPERATURES, "frequency_Hz", "nominal_frequency_Hz")
LABELS = ("specimen", "replicate", "mix", "origin")
_BEFORE = (
    r"(?:(?:\b(?:at|à|bei|for|für|temperature|température|temperatur|temp|frequency|fréquence|frequenz|freq|[Tfθ])\b\.?"
    r"|@|,|;|[=:])\s*)*"
)
_TEMPERATURE = re.compile(
    _BEFORE
    + r"(?<![\d.,])(?P<at>[-−]?\d+(?:[.,]\d+)?)\s*(?:[°º]\s*|deg(?:rees?)?\.?\s?)?(?P<unit>[CF])(?![\w*'°])"
)
_FREQUENCY = re.compile(_BEFORE + r"(?<![\d.,])(?P<at>\d+(?:[.,]\d+)?)\s*(?P<unit>Hz)\b", re.IGNORECASE)
_SPECIMEN_WORD = f"(?:{'|'.join(SAY['specimen'])})"
_SPECIMEN = re.compile(
    rf"(?:\b(?:for|of|de|von)\s+)?(?P<at>\b{_SPECIMEN_WORD}\b\.?\s*(?:no\b\.?|nr\b\.?|n[°º]|#)?\s*[:.]?[\s_-]*"
    r"(?:[A-Za-z]{0,3}[-_]?\d+[A-Za-z]?|[A-Z]))(?!\w)",
    re.IGNORECASE,
)
_TRAILING = (re.compile(r"(.*\S)[\s_-]+([A-Z]\d{0,3})"), re.compile(r"(.*\S)[\s_.#-]*(\d{1,3})"))
_UNIT_AT_END = re.compile(r"(?P<stem>.*?)\s*(?P<unit>[(\[{][^()\[\]{}]*[)\]}])\s*")


@dataclass(frozen=True)
class Heading:
    """A heading without its conditions, `|E*| (MPa)`, and the conditions.

    `at` has them by the column that each becomes; `left_out` marks a heading of deviations of other columns.
    """

    name: str
    at: Mapping[str, str] = field(default_factory=dict)
    left_out: bool = False

    @property
    def column(self) -> Meaning | None:
        """The quantity it names; None if none is known, or with a unit of another."""
        return known(self.name)

    @property
    def quantity(self) -> str:
        """Our column for it; empty if none is known."""
        return quantity_of(self.name)

    @property
    def is_result(self) -> bool:
        """Whether it names what a test gives, and no temperature, frequency or label."""
        return self.quantity not in ("", *KEYS, *LABELS)


# Each cell of a file is understood once, and asked for several times.
@lru_cache(maxsize=2**14)
def known(name: str) -> Meaning | None:
    """The column that a name stands for; None also where it has a unit of another quantity."""
    try:
        return recognise(name) if name else None
    except InputError:  # `understand` refuses it
        return None


def quantity_of(name: str) -> str:
    """Our column for a name; empty if it is none that is known."""
    column = known(name)
    return "" if column is None else column.quantity


@lru_cache(maxsize=2**14)
def read_heading(text: str) -> Heading:
    """Name and conditions in the text of one heading cell."""
    # A name known as it stands holds no condition: `E2` is the loss modulus, and no second specimen.
    if len(text) > LONGEST_NAME or known(text) is not None:
        return Heading(text)
    if SPREAD.search(text):
        stem = SPREAD.sub(" ", text)
        of_result = any(Heading(_tidy(part)).is_result for part in (stem, re.sub(r"[(\[].*", "", stem)))
        return Heading(text, left_out=of_result)
    at: dict[str, str] = {}
    bracketed = _UNIT_AT_END.fullmatch(text)
    stem, unit = (bracketed["stem"], f" {bracketed['unit']}") if bracketed else (text, "")
    if bracketed and not known(_tidy(stem) + unit) and condition(bracketed["unit"].strip("()[]{}")):
        stem, unit = text, ""  # `E* (4 °C)`
    stem = _taken(stem, at)
    for name in (_tidy(stem) + unit, _tidy(stem + unit)):
        if at and Heading(name).is_result:
            return Heading(name, at)
    # `|E*| 2` or `E* A`: a number or a single letter behind the name is a specimen.
    for trailing in filter(None, (pattern.fullmatch(_tidy(stem)) for pattern in _TRAILING)):
        heading = Heading(_tidy(trailing[1]) + unit)
        if heading.is_result and SPECIMEN not in at:
            return Heading(heading.name, at | {SPECIMEN: trailing[2]})
    return Heading(text)


def condition(text: str) -> dict[str, str]:
    """Conditions of a cell that holds nothing else, `T = 4 °C`, by the column that each becomes; else empty."""
    at: dict[str, str] = {}
    return at if len(text) <= LONGEST_NAME and not _tidy(_taken(text, at)) else {}


def strip_conditions(name: str) -> str:
    """Name of a column without the conditions that its heading carries."""
    return read_heading(name).name


def _taken(text: str, at: dict[str, str]) -> str:
    """The text without its conditions, which go into `at`."""
    for pattern in (_TEMPERATURE, _FREQUENCY, _SPECIMEN):
        found = pattern.search(text)
        if found is None:
            continue
        unit = found.groupdict().get("unit", "")
        key = {"C": CELSIUS, "F": FAHRENHEIT, "": SPECIMEN}.get(unit, HERTZ)
        at[key] = found["at"].strip().replace("−", "-")
        text = f"{text[: found.start()]} {text[found.end() :]}"
    if SPECIMEN not in at and (found := MEAN_WORD.search(text)):
        at[SPECIMEN] = MEAN
        text = f"{text[: found.start()]} {text[found.end() :]}"
    return text


def _tidy(text: str) -> str:
    """The text without the marks and empty brackets that a condition leaves behind."""
    return re.sub(r"[(\[]\s*[,;]?\s*[)\]]", " ", text).strip(" ,;:@_-–")


def is_spread(label: str) -> bool:
    """Whether the label in place of a specimen says that a column holds deviations of others."""
    return bool(SPREAD.match(label))
