"""What a diagnosis leaves unexplained, and what it could not have seen, in words."""

from __future__ import annotations

from collections.abc import Mapping

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.words.sentences import Content, exceeds_scatter, isotherms, odd, typed
from asphalt_nscd.diagnosis.written import shown, three_digits
from asphalt_nscd.files.words import joined, specimen_named

OF_WHAT_IS_LEFT = (
    "The four largest misfits of the free master curve, scatter subtracted. residuals.csv has each test."
)
MANY_SPECIMENS = 5  # from here on one odd specimen hardly moves the common curve
LARGEST = 4  # parts of what stays unexplained that are listed


def absence_note(content: Content) -> str:
    """A sentence that nothing was named; empty where a cause was."""
    named = any(rung["cause"] != "relaxation_spectrum" for rung in content["ladder"])
    return "" if named else "No cause is named."


def unseen(content: Content) -> list[str]:
    """How large the commonest unnamed faults may be without these tests showing them; empty where none was judged."""
    named = {rung["cause"] for rung in content["ladder"]}
    never = [one["cause"] for one in content["not_testable"]]
    told = []
    for cause in CATALOGUE:
        limit = content["detection_limits"].get(cause.name)
        if cause.unseen and limit and cause.name not in named:
            told.append(f"{cause.unseen} smaller than {_sizes(limit, content)}.")
        elif cause.unseen and cause.name in never:
            told.append(f"{cause.unseen}, of any size.")
    return told


def _sizes(limit: Content, content: Content) -> str:
    """A limit, or that at each temperature where it depends on it."""
    places = limit.get("places", {})
    if not places:
        return _size(limit["value"], limit["unit"])
    sizes = [f"{_size(places[at], limit['unit'])} at {float(at):g} degC" for at in sorted(places, key=float)]
    never = [f"{t:g}" for t in isotherms(content) if t not in map(float, places)]
    return joined(sizes) + (f", and of any size at {joined(never)} degC" if never else "")


def _size(value: float, unit: str) -> str:
    size, name = shown(value, unit)
    return f"{size:.2g} {typed(name)}"


def left(content: Content) -> list[str]:
    """At most LARGEST parts that no cause explains, largest first, in % of |E*| or degrees; empty if none is left."""
    parts = sorted(content["discrepancy"], key=lambda one: -one["size"])[:LARGEST]
    if parts:
        return [*(_part_left(one, content) for one in parts), *remarks(content)]
    pattern = content["largest_pattern_left"]
    if content["verdict"] == "unexplained_structure" and pattern is not None and exceeds_scatter(content):
        if len(isotherms(content)) == 1:  # where a slope over temperature has no meaning
            return _largest(content)
        return [f"{pattern['pattern']}: {three_digits(pattern['z'])} times its standard error"]
    return []


def remarks(content: Content, most: int = LARGEST) -> list[str]:
    """On the sizes of what is left: what they include, and that few specimens do not tell which one is odd.

    Of few specimens each has a large part in the common curve that it is compared with. `most` is how many parts the
    reader is shown; sentences are without their full stop.
    """
    places = levels.places(*odd(content))
    said = [f"These sizes include what is odd: {joined(places)}"] if places else []
    specimens = len(content["reading"]["specimens"])
    largest = sorted(content["discrepancy"], key=lambda one: -one["size"])[:most]
    if not places and 1 < specimens < MANY_SPECIMENS and any(one["specimen"] is not None for one in largest):
        said.append(f"{specimens} specimens are too few to tell which one is odd")
    return said


def _largest(content: Content) -> list[str]:
    """The mean residual that is left over most, where a slope over temperature has no meaning."""
    found = [one for one in content["unexplained"] if one["specimen"] is None][:1]
    return [
        f"{abs(one['residual_E_percent']):.1f} % in |E*| and {abs(one['residual_phase_deg']):.1f} deg in the phase at "
        f"{one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz"
        for one in found
    ]


def _part_left(one: Content, content: Content) -> str:
    """One part of the discrepancy, its size first."""
    size = size_left(one["part"], one["size"], content["scatter"])
    if one["specimen"] is None:
        t = one["temperature_C"]
        return f"{size} of all tests" if t is None else f"{size} at {t:g} degC"
    size = f"{size} of {specimen_named(one['specimen'])}"
    if one["kind"] == "spectrum":
        return f"{size}: its master curve has another shape than the common one"
    whole = [odd["specimen"] for odd in content["odd_phases"] if odd["temperature_C"] is None]
    if one["part"] == "phase" and one["specimen"] in whole:
        return f"{size}, most of it alike in all its tests"
    return f"{size}, changing with frequency and temperature"


def size_left(part: str, value: float, scatter: Mapping[str, float]) -> str:
    """Size of a part of the discrepancy (`value` in units of scatter), in % of |E*| or, of the phase, in degrees."""
    if part == "phase":
        return f"{_one_digit(value * scatter['phase_deg'])} deg in the phase"
    return f"{_one_digit(value * scatter['modulus_percent'])} % in |E*|"


def _one_digit(value: float) -> str:
    return f"{value:.1f}" if value >= 0.1 else f"{value:.1g}"
