"""What a diagnosis says in plain sentences, for the terminal and for the page alike.

Units are written as on a terminal (degC, deg, +-); the page sets them in type.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis import written
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.content import ITSELF, LEFT_OUT
from asphalt_nscd.diagnosis.criteria import ALPHA_PER_STEP, LEAST_ISOTHERMS, NAMED
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.written import shown, three_digits
from asphalt_nscd.files.words import counted, joined, specimen_named

Content = Mapping[str, Any]
SIGNS = {cause.name: cause.signs for cause in CATALOGUE if cause.signs is not None}
BOUNDS = {cause.name: {cause.parameters[0].low, cause.parameters[0].high} - {0.0} for cause in CATALOGUE}
ORIGINS = {
    "measured": "No file says that the data are synthetic or reconstructed: they are taken for measurements.",
    "digitised": "The data were read off figures; what is found may be an error of that reading.",
    "reconstructed": (
        "This diagnosis rests on reconstructed data. They are not measurements: they were drawn about one smooth "
        "law fitted to the published Burgers parameters, so that a cause found here is one of this reconstruction."
    ),
    "synthetic": "The data are synthetic: what is found here says nothing of a mix or of a rig.",
}
LAW = "relaxation_spectrum"
BURGERS_MISS = (
    "Established: a Burgers law at each temperature is not enough. The chance that scatter alone makes it miss by so "
    "much is"
)
RANKED = "In this order: checks, doubtful tests again, then the tests that tell most per hour."
ENOUGH = "four temperatures, three frequencies and two specimens"  # for a name to be established
WORSE = 1.05  # times the misfit without a cause, from which it is told that the cause does not help


def odd(content: Content) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Odd isotherms in |E*|, then odd isotherms and specimens (temperature_C None) in phase."""
    return content["odd_levels"], content["odd_phases"]


def unused_tests(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis left out, in their order."""
    return [one for one in content["suspect_tests"] if one["status"] == LEFT_OUT]


def doubtful(content: Content) -> list[Content]:
    """Tests that their own isotherm speaks against and that the diagnosis used all the same, in their order."""
    return [
        one for one in content["suspect_tests"] if ITSELF in one["decided_by"] and one["status"] != LEFT_OUT
    ]


def suspect_change(content: Content) -> str:
    """What the suspect tests would have changed, had they been used; empty where no test is left out."""
    return _changed(content, "with_suspects", "If the tests left out were kept")


def doubtful_change(content: Content) -> str:
    """What is named without the doubtful tests that are used; empty where there are none."""
    when = "If the doubtful tests were left out"
    return _changed(content, "without_doubtful", when) if doubtful(content) else ""


def only_with_suspects(content: Content) -> str:
    """What only the tests left out speak for, or against; empty where they change no name."""
    return _changed(content, "with_suspects", "With these tests", alike="")


def _changed(content: Content, key: str, when: str, alike: str = "name the same causes") -> str:
    """What another choice of tests would name; alike: if the same, a law is no fault. Empty where there was none."""
    then = content[key]
    if then is None:
        return ""
    now = [cause_words(rung) for rung in content["ladder"] if rung["cause"] not in (BOND_MAPPING, LAW)]
    other = [cause_words(rung) for rung in then["causes"] if rung["cause"] != LAW]
    more, less = (
        [article(one) for one in other if one not in now],
        [article(one) for one in now if one not in other],
    )
    changes = [f"{'also ' * (len(more) < len(other))}name {joined(more)}"] if more else []
    changes += [f"no longer name {joined(less)}"] if less else []
    would = joined(changes) or alike
    return f"{when}, the diagnosis would {would}." if would else ""


def named(content: Content, cause: str) -> bool:
    """Whether a cause, or the law or the bonds, is a rung of the ladder at any place."""
    return any(rung["cause"] == cause for rung in content["ladder"])


def place_of_test(one: Content) -> str:
    """A test in words, as a reader finds its row in a table: `specimen 2, 30 degC, 10 Hz`."""
    return f"{specimen_named(one['specimen'])}, {one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz"


def interval_note(content: Content) -> str:
    """What +- on a size says, and more where the tests lie far from the fit; empty where nothing was named."""
    if not content["ladder"]:
        return ""
    factor = widened(content)
    if factor == 1.0:
        return "+- is the 95 % interval."
    return (
        f"+- is the 95 % interval. The tests lie {factor:.1f} times as far from the common master curve as their "
        f"scatter explains, so it was widened {factor:.1f} times."
    )


def widened(content: Content) -> float:
    """Factor on the intervals: one where scatter explains how far the tests lie from the fit, else above one."""
    return written.widening(content["estimates_spread"])


def origin(content: Content) -> list[str]:
    """What the origin of the data means, a sentence for each known word; if none is known, one that quotes it."""
    stated = content["origin"]
    return [sentence for word, sentence in ORIGINS.items() if word in stated] or [f"The data are {stated}."]


def law_of_the_mix(content: Content) -> tuple[str, str] | None:
    """The relaxation spectrum with its shift, and how sure it is, in words; None where no test asks for one."""
    for rung in content["ladder"]:
        if rung["cause"] == LAW:
            told = f"Time-temperature shift of the free master curve: {_shift(rung, widened(content))}"
            return told.removesuffix(": "), _sure(rung, content)
    return None


def _shift(rung: Content, factor: float) -> str:
    """The constants of the shift with temperature, and at which temperature they hold; factor: on their intervals."""
    found = rung["parameters"]
    constants = [
        f"{name.replace('_', ' ').replace('wlf ', 'WLF ')} {estimate(one, factor)}"
        for name, one in found.items()
        if name != "reference_temperature"
    ]
    if "reference_temperature" in found and constants:
        reference = three_digits(found["reference_temperature"]["value"])
        constants.append(f"reference temperature {reference} degC")
    return ", ".join(constants)


def causes(content: Content) -> list[tuple[str, str]]:
    """Each named cause with its size, then the meaning of its sign, how sure it is and what would confirm it."""
    return [
        (
            f"{cause_words(rung)}: {size(rung, content)}".removesuffix(": "),
            f"{meaning(rung)}{_sure(rung, content)}{_omission_reason(rung)}{_confirming_measurement(rung)}",
        )
        for rung in content["ladder"]
        if rung["cause"] != LAW
    ]


def _omission_reason(rung: Content) -> str:
    """Why the answer does not mention a cause."""
    if rung["established"] or not worsens(rung):
        return ""
    return " It is not in the answer above: if all tests count alike, they fit worse with it than without it."


def _confirming_measurement(rung: Content) -> str:
    """Only where the simulations do not show it by themselves."""
    return "" if rung["cause"] == BOND_MAPPING else f" To confirm it: {rung['confirmed_by']}."


def meaning(rung: Content) -> str:
    """What the sign of the amplitude says, a sentence and a space; empty for a cause that has but one."""
    if rung["cause"] not in SIGNS:
        return ""
    above, below = SIGNS[rung["cause"]]
    return f"{above if next(iter(rung['parameters'].values()))['value'] > 0.0 else below} "


def _sure(rung: Content, content: Content) -> str:
    if rung["cause"] == BOND_MAPPING:
        return f"Established: {rung['evidence']}."
    chance = "below one in a million" if rung["p_value"] < 1e-6 else _percentage(rung["p_value"])
    likely = f", with a probability of {probability(rung)}" if rung["probability"] is not None else ""
    doubts = _doubts(rung, content)
    if doubts:
        first, *more = doubts
        return f"Not certain: {'. '.join([first[:1].lower() + first[1:], *more])}."
    if not rung["established"]:
        return f"Not certain: {lacking(content)}."
    if rung["cause"] == LAW:  # the Burgers laws are those of the simulated paper
        return f"{BURGERS_MISS} {chance}." if named(content, BOND_MAPPING) else ""
    if content["discrepancy"]:
        return f"Established{likely}. It stays whichever isotherm, frequency or specimen is left out."
    return f"Established{likely}: the chance that scatter alone produces it is {chance}."


def rivals(rung: Content, content: Content) -> list[str]:
    """Causes, none of them named, that fit as well as a name, in words."""
    known = {written.name_at(one["cause"], one["where"]) for one in content["ladder"]}
    return [spell_cause(name) for name in rung["as_good"] if name not in known]


def _doubts(rung: Content, content: Content) -> list[str]:
    """Why a name is not certain, a sentence each without its full stop."""
    doubts = []
    fit_as_well = rivals(rung, content)
    others = joined(fit_as_well, "or")
    also = joined([name for name in map(spell_cause, rung["as_good"]) if name not in fit_as_well])
    if others:
        doubts.append(f"{others} fits as well; these tests do not say which")
    if also:
        doubts.append(f"{also} would have fitted as well before both were named")
    if rung["hangs_on"]:
        doubts.append(f"It is no longer found if {joined(rung['hangs_on'], 'or')} is left out")
    doubts += rung["doubts"]
    if rung["probability"] is not None and rung["probability"] < NAMED:
        doubts.append(f"Its probability is {probability(rung)}, and certainty takes {100.0 * NAMED:.0f} %")
    if doubts and (0 < len(isotherms(content)) < LEAST_ISOTHERMS or not content["tested"]):
        doubts.append(f"Besides, {lacking(content)}")
    return doubts


def probability(rung: Content) -> str:
    """Probability of a name at its place in whole percent; that another cause or none holds is the rest."""
    return f"{100.0 * rung['probability']:.0f} %"


def worsens(rung: Content) -> bool:
    """Whether the tests, counted alike, fit worse with a cause than without it (above WORSE times the misfit)."""
    fits = rung["gain"]["in_sample"].get("rms_over_scatter")
    return bool(fits) and fits["after"] > WORSE * fits["before"]


def lacking(content: Content) -> str:
    """Clauses on what a table has too little of for a name to be certain; if nothing, on what certainty takes."""
    at, few = len(isotherms(content)), []
    if 0 < at < LEAST_ISOTHERMS:
        tested = f"{counted(at, 'temperature')} {'was' if at == 1 else 'were'} tested"
        few.append(f"only {tested}, and certainty takes {LEAST_ISOTHERMS}")
    if alone(content):
        few.append("no condition was tested on a second specimen")
    elif not content["tested"]:
        few.append("only two frequencies were tested, and certainty takes 3")
    return "; ".join(few) or f"certainty takes {ENOUGH}"


def spell_cause(name: str) -> str:
    """A cause and its place (isotherm [degC] or specimen) as `temperature_bias @ 21.0`, in words."""
    cause, _, place = name.partition(" @ ")
    where = float(place) if place and written.CONFINED_TO.get(cause) == "temperature_C" else place or None
    return cause_words({"cause": cause, "where": where})


def alone(content: Content) -> bool:
    """Whether nothing tells the scatter (one specimen, none stated), so that it is what a smooth law leaves."""
    known = content["scatter"]["from_replicates"]
    return not (known or content["provenance"]["scatter_stated"])


def isotherms(content: Content) -> list[float]:
    """Nominal temperatures tested [degC]; none where a file does not say."""
    return list(content["reading"]["isotherms_C"])


def exceeds_scatter(content: Content) -> bool:
    """Whether named causes leave structure, by lack of fit or largest pattern left, at half a step's chance each."""
    pattern = content["largest_pattern_left"]
    chances = [content["lack_of_fit_p_value"], 1.0 if pattern is None else pattern["p_value"]]
    return min(chances) <= 0.5 * ALPHA_PER_STEP


def size(rung: Content, content: Content) -> str:
    """Amplitude of a cause with 95 % interval and unit; or that the search ends there; empty where none is given."""
    amplitude = next(iter(rung["parameters"].values()))
    if amplitude["std_error"] is not None and amplitude["value"] in BOUNDS.get(rung["cause"], ()):
        value, unit = shown(amplitude["value"], amplitude["unit"])
        beyond = "more" if amplitude["value"] > 0.0 else "less"
        return f"{three_digits(value)} {typed(unit)} or {beyond} (the search ends there)"
    # No measurement widens what simulations show.
    return estimate(amplitude, 1.0 if rung["cause"] == BOND_MAPPING else widened(content))


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


def typed(unit: str) -> str:
    """A unit as it is typed without a degree sign: deg or degC."""
    return {"\N{DEGREE SIGN}": "deg", "\N{DEGREE SIGN}C": "degC"}.get(unit, unit)


def cause_words(rung: Content) -> str:
    """A cause and its place in words: `temperature bias at 30 degC`, `loose clamp of specimen 2`."""
    words, where = rung["cause"].replace("_", " "), rung["where"]
    if where is None:
        return words
    return f"{words} of {specimen_named(where)}" if isinstance(where, str) else f"{words} at {where:g} degC"


def capital(words: str) -> str:
    """The words with a capital first; units keep theirs."""
    return f"{words[:1].upper()}{words[1:]}"


def article(words: str) -> str:
    """The words (not empty) with their article, by the first letter, a vowel or not."""
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def _percentage(chance: float) -> str:
    return f"{three_digits(float(f'{100.0 * chance:.1g}'))} %"
