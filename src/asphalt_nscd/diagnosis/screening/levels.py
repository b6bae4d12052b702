"""Words for faults of one place: a sweep odd in |E*|, phase or temperature, a specimen odd in phase as a whole."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.written import interval_text
from asphalt_nscd.files.words import specimen_named

EXCHANGED = 0.25  # of ln|E*|, within which two departures are equal and opposite
# Factor between an error of a temperature and the step to another, within which their sweeps look exchanged.
ALIKE = 2.0
OF_SPECIMEN = "its gauges, channels and mounting"
ONE_MIX = 25.0  # percent by which specimens of one mix hardly differ; T 378 expects some 13


def rows(observed: Observations, found: Iterable[Mapping[str, Any]]) -> NDArray[np.bool_]:
    """Tests (n,) of the sweeps, and of the specimens as a whole (temperature_C None), that were found odd."""
    out = np.zeros(observed.size, bool)
    for one in found:
        here = observed.specimen == observed.names.index(one["specimen"])
        out |= here if one["temperature_C"] is None else here & (observed.isotherm == one["temperature_C"])
    return out


def sentences(levels: list[dict[str, Any]], phases: list[dict[str, Any]]) -> list[str]:
    """What is odd and what to check, a sentence each without its full stop, isotherms in |E*| first."""
    return [f"{what}: check {check}" for what, check in map(described, [*levels, *phases])]


def temperature_notes(found: Iterable[Mapping[str, Any]]) -> list[str]:
    """Temperatures of sweeps and what to check first, a sentence each without its full stop."""
    return [
        f"at {one['temperature_C']:g} degC {specimen_named(one['specimen'])} seems {_size(one, 'kelvin')} K "
        f"{'warmer' if one['kelvin'] > 0.0 else 'colder'} than stated: check its conditioning and the record"
        for one in found
    ]


def swap_notes(levels: Sequence[Mapping[str, Any]], temperatures: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sweeps that look as if each stood in the other's place, a sentence each without its full stop."""
    found = []
    for one, other in combinations(temperatures, 2):
        apart = other["temperature_C"] - one["temperature_C"]
        seem = (one["kelvin"] / apart, -other["kelvin"] / apart) if apart else (0.0, 0.0)
        if one["specimen"] == other["specimen"] and all(1.0 / ALIKE < share < ALIKE for share in seem):
            found.append(
                f"{specimen_named(one['specimen'])}: the sweeps at {one['temperature_C']:g} and "
                f"{other['temperature_C']:g} degC look exchanged: check the record"
            )
    for one, other in combinations(levels, 2):
        inverse = abs(np.log(one["factor"] * other["factor"])) < EXCHANGED * abs(np.log(one["factor"]))
        if one["temperature_C"] == other["temperature_C"] and inverse:
            low, high = sorted((one, other), key=lambda of: of["factor"])
            found.append(
                f"at {one['temperature_C']:g} degC {specimen_named(low['specimen'])} is as far below its level of |E*| "
                f"as {specimen_named(high['specimen'])} is above: check whether their files were exchanged"
            )
    return found


def described(one: Mapping[str, Any]) -> tuple[str, str]:
    """What is odd, and what to check, in |E*| or phase."""
    others = "what its other temperatures and the other specimens say"
    if "factor" in one:
        return (
            f"{place(one)}: |E*| {one['factor']:.2f} times {others}",
            "gauges, gain, unit and entered dimensions of these tests",
        )
    if "delay_s" in one:
        late = "after" if one["delay_s"] > 0.0 else "before"
        return (
            f"{place(one)}: displacement recorded {_size(one, 'delay_s', 1e3)} ms {late} the force, "
            f"{abs(one['phase_deg']):.1f} deg at the highest frequency",
            "filters and settings of its channels",
        )
    side = "above" if one["phase_deg"] > 0.0 else "below"
    size = f"{place(one)}: phase {_size(one, 'phase_deg')} deg {side}"
    if one["temperature_C"] is None:
        return f"{size} what its |E*| and the other specimens say, in all its tests", OF_SPECIMEN
    return f"{size} {others}", "gauges, channels and temperature of these tests"


def _size(one: Mapping[str, Any], key: str, factor: float = 1.0) -> str:
    """Absolute value times a factor, with its interval."""
    low, high = one["interval_95"]
    return interval_text(factor * abs(one[key]), 0.5 * factor * (high - low))


def if_sound(one: Mapping[str, Any]) -> str:
    """What new tests show if not the specimen but its tests were odd: a clause on |E*| or on the phase."""
    if "factor" in one:
        return f"|E*| is about {1.0 / one['factor']:.2f} times the old one"
    return f"phase is about {abs(one['phase_deg']):.1f} deg {'lower' if one['phase_deg'] > 0.0 else 'higher'}"


def place(one: Mapping[str, Any]) -> str:
    """An odd isotherm or specimen (temperature_C None) in words, for example specimen 2 at 30 degC."""
    at = "" if one["temperature_C"] is None else f" at {one['temperature_C']:g} degC"
    return specimen_named(one["specimen"]) + at


def places(*odd: Iterable[Mapping[str, Any]]) -> list[str]:
    """Each isotherm or specimen that is odd in |E*|, phase or temperature once, in words."""
    return list(dict.fromkeys(map(place, chain(*odd))))
