"""What campaigns of one machine have in common, as a table and in sentences."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import pandas as pd

from asphalt_nscd.diagnosis.causes._cause import Cause
from asphalt_nscd.diagnosis.criteria import CONFIDENCE
from asphalt_nscd.diagnosis.words.sentences import article, typed
from asphalt_nscd.diagnosis.written import UNITS, interval_text, shown, three_digits
from asphalt_nscd.files.words import joined

SHOWS = 5.0  # times the error of the whole, up to which a part is told


@dataclass(frozen=True)
class Part:
    """An amplitude in one campaign, isotherm or frequency, in the unit of its cause; NaN where nothing shows it."""

    where: str
    value: float
    std_error: float


@dataclass(frozen=True)
class Common:
    """A cause that all campaigns share. value, std_error: in the unit of its amplitude.

    p_value: of the largest of all causes;
    campaigns, isotherms, frequencies: the same amplitude from each alone; differs: what it differs between by more than
    chance, of "campaigns", "isotherms" and "frequencies"; as_good: causes that fit as well.
    """

    cause: Cause
    p_value: float
    as_good: tuple[str, ...]
    value: float = 0.0
    std_error: float = 0.0
    campaigns: tuple[Part, ...] = ()
    isotherms: tuple[Part, ...] = ()
    frequencies: tuple[Part, ...] = ()
    differs: Mapping[str, float] = field(default_factory=dict)

    @property
    def named(self) -> bool:
        """Whether one size fits all; else it is common, but not known to be this cause."""
        return not self.differs


@dataclass(frozen=True)
class Pooled:
    """What the campaigns of a machine have in common.

    `found` lists common causes first; `limits` are amplitudes of each cause that the campaigns would show together;
    `left_out` are campaigns that one law does not describe.
    """

    found: tuple[Common, ...]
    limits: Mapping[str, float]
    left_out: tuple[str, ...]

    @property
    def table(self) -> pd.DataFrame:
        """A row for each cause that is common, and for the same from each campaign, isotherm and frequency alone."""
        rows = []
        for one in self.found:
            whole = Part("all campaigns", one.value, one.std_error)
            for part in (whole, *one.campaigns, *one.isotherms, *one.frequencies):
                value, unit = shown(part.value, one.cause.parameters[0].unit)
                error, _ = shown(part.std_error, one.cause.parameters[0].unit)
                rows.append((one.cause.name, one.named, part.where, value, error, unit))
        return pd.DataFrame(rows, columns=["cause", "named", "where", "value", "std_error", "unit"])

    def __str__(self) -> str:
        """What the campaigns have in common, for a reader: sentences, one a line."""
        said = [_sentence(one) for one in self.found] or ["Nothing common to the campaigns stands out."]
        rest = [
            f"{name.replace('_', ' ')} below {three_digits(value)} {typed(unit)}"
            for name, size in self.limits.items()
            if name not in {one.cause.name for one in self.found}
            for value, unit in [shown(size, UNITS[name])]
        ]
        if rest:
            said.append(f"A common {joined(rest, 'or')} would mostly stay unseen.")
        if self.left_out:
            why = "one isotherm, or no law common to its isotherms"
            said.append(f"Not used for this: {joined(self.left_out)}; {why}.")
        return "\n".join(said)


def _sentence(one: Common) -> str:
    """A cause with its 95 % interval; or how its size differs, and that it is then not this cause alone."""
    unit = one.cause.parameters[0].unit
    value = shown(one.value, unit)[0]
    name = typed(shown(one.value, unit)[1])
    half = CONFIDENCE * shown(one.std_error, unit)[0]
    size, words = f"{interval_text(value, half)} {name}", one.cause.name.replace("_", " ")
    if one.named:
        others = joined([article(other.replace("_", " ")) for other in one.as_good], "or")
        or_else = f"; {others} would fit as well" if others else ""
        return f"Machine: {words} in all campaigns, {size} (95 % interval){or_else}."
    differ = []
    for group in one.differs:
        parts = getattr(one, group)
        # With many parts each is uncertain: then all with a finite error count.
        known = [part for part in parts if part.std_error < SHOWS * one.std_error]
        known = known or [part for part in parts if math.isfinite(part.std_error)]
        low, high = min(known, key=lambda part: part.value), max(known, key=lambda part: part.value)
        ends = [f"{three_digits(shown(part.value, unit)[0])} {name} ({part.where})" for part in (low, high)]
        differ.append(f"between {group} from {ends[0]} to {ends[1]}")
    return (
        f"Common to the campaigns, without a name: they look as with {article(words)} of {size}, but its size differs "
        f"{joined(differ)}. So it is no {words} of the machine alone."
    )
