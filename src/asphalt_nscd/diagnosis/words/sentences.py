"""How causes, their sizes and places are written in a sentence.

Units are written as on a terminal (degC, deg, +-); the page sets them in type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis import written
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.next_tests.fixed_orders import MANY, band  # noqa: F401  of the templates
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.written import shown, three_digits
from asphalt_nscd.files.words import joined, numbers, specimen_named

Content = Mapping[str, Any]
CAUSES = {cause.name: cause for cause in CATALOGUE}
SURE = 1e-6  # chance below which no number is told


def cause_words(rung: Content) -> str:
    """A named cause and its place in words."""
    return written.cause_at(rung["cause"], rung["where"])


def spell_cause(name: str) -> str:
    """A cause and its place (isotherm [degC] or specimen) as `temperature_bias @ 21.0`, in words."""
    cause, _, place = name.partition(" @ ")
    at_isotherm = place and written.CONFINED_TO.get(cause) == "temperature_C"
    return written.cause_at(cause, float(place) if at_isotherm else place or None)


def widened(content: Content) -> float:
    """Factor on the intervals: one where scatter explains how far the tests lie from the fit, else above one."""
    return written.widening(content["estimates_spread"])


def amplitude(rung: Content) -> dict[str, Any]:
    """The estimate of the amplitude of a named cause: value, std_error, unit."""
    return dict(next(iter(rung["parameters"].values())))


def size(rung: Content, content: Content) -> str:
    """Amplitude of a cause with 95 % interval and unit; or that the search ends there; empty where none is given."""
    one, cause = amplitude(rung), CAUSES.get(rung["cause"])
    ends = {cause.parameters[0].low, cause.parameters[0].high} - {0.0} if cause else set()
    if one["std_error"] is not None and one["value"] in ends:
        beyond = "more" if one["value"] > 0.0 else "less"
        return f"{estimate(one | {'std_error': None})} or {beyond} (the search ends there)"
    # No measurement widens what simulations show.
    return estimate(one, 1.0 if rung["cause"] == BOND_MAPPING else widened(content))


def estimate(one: Content, factor: float = 1.0) -> str:
    """A value with unit and 95 % interval times `factor`: +- half of it, or both ends; none without std_error."""
    value, unit = shown(one["value"], one["unit"])
    if one["std_error"] is None:
        return f"{three_digits(value)} {typed(unit)}".rstrip()
    low, high = written.interval_95(one["value"], one["std_error"], factor)
    told = one.get("interval_95") or (low, high)
    if not np.isclose(sum(told), low + high, rtol=1e-6, atol=0.0):  # of the logarithm
        ends = " to ".join(three_digits(shown(end, one["unit"])[0]) for end in told)
        return f"{three_digits(value)} ({ends}) {typed(unit)}"
    half = shown(0.5 * (high - low), one["unit"])[0]
    return f"{written.interval_text(value, half)} {typed(unit)}".rstrip()


def meaning(rung: Content) -> str:
    """What the sign of the amplitude says, a sentence; empty for a cause that has but one."""
    cause = CAUSES.get(rung["cause"])
    if cause is None or cause.signs is None:
        return ""
    above, below = cause.signs
    return above if amplitude(rung)["value"] > 0.0 else below


def correction(rung: Content) -> str:
    """What to do to the tests to be rid of a fault, where it is one number; empty where no one number corrects it."""
    cause = CAUSES.get(rung["cause"])
    return "" if cause is None else cause.correction(amplitude(rung)["value"], rung["where"])


def probability(rung: Content) -> str:
    """Probability of a name at its place in whole percent; that another cause or none holds is the rest."""
    return f"{100.0 * rung['probability']:.0f} %"


def chance(value: float) -> str:
    """A chance to one digit, in percent."""
    if value < SURE:
        return "below one in a million"
    return f"{three_digits(float(f'{100.0 * value:.1g}'))} %"


def limit_size(value: float, unit: str) -> str:
    """A limit to two digits with its unit."""
    size, name = shown(value, unit)
    return f"{float(f'{size:.2g}'):g} {typed(name)}".rstrip()


def size_left(part: str, value: float, scatter: Mapping[str, float]) -> str:
    """Size of a part of the discrepancy (`value` in units of scatter), in % of |E*| or, of the phase, in degrees."""
    key, unit = ("phase_deg", "deg in the phase") if part == "phase" else ("modulus_percent", "% in |E*|")
    size = value * scatter[key]
    return f"{size:.1f} {unit}" if size >= 0.1 else f"{size:.1g} {unit}"


def typed(unit: str) -> str:
    """A unit as it is typed without a degree sign: deg or degC."""
    return {"\N{DEGREE SIGN}": "deg", "\N{DEGREE SIGN}C": "degC"}.get(unit, unit)


def article(words: str) -> str:
    """The words (not empty) with their article, by the first letter, a vowel or not."""
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def noun(rung: Content) -> str:
    """A named cause as a thing that tests show, with its article."""
    words = cause_words(rung)
    return article(words.replace("specimen geometry", "error of the dimensions") if rung["where"] else words)


def shift(rung: Content, content: Content) -> list[str]:
    """The constants of the shift with temperature, and at which temperature they hold; empty where it has none."""
    constants = [
        f"{name.replace('_', ' ').replace('wlf ', 'WLF ')} {estimate(one, widened(content))}"
        for name, one in rung["parameters"].items()
    ]
    return constants if len(constants) > 1 else []


def both_scatters(variation: Content) -> str:
    """A scatter of |E*| and of the phase."""
    return f"{variation['E_percent']:.1f} % in |E*|, {variation['phase_deg']:.1f} deg in phase"


def two_errors(errors: Sequence[float], in_degrees: bool) -> list[str]:
    """Errors of |E*| [%] and of the phase, in % or `in_degrees`, to two digits."""
    units = ("%", "deg" if in_degrees else "%")
    return [f"{float(f'{error:.2g}'):g} {unit}" for error, unit in zip(errors, units, strict=True)]


def limits(limit: Content, isotherms: Sequence[float]) -> str:
    """A detection limit, or that of each specimen or temperature where it depends on it."""
    unit = limit["unit"]
    if "places" not in limit:
        return limit_size(limit["value"], unit)
    if limit["confined_to"] == "specimen":
        return joined(
            [f"{limit_size(size, unit)} of {specimen_named(at)}" for at, size in limit["places"].items()]
        )
    places = {float(at): value for at, value in limit["places"].items()}
    sizes = [f"{limit_size(places[at], unit)} at {at:g} degC" for at in sorted(places)]
    never = [t for t in isotherms if t not in places]
    return joined(sizes) + (f", and of any size at {numbers(never)} degC" if never else "")
