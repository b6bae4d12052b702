"""What a diagnosis holds, as its words ask for it: which causes and tests, and whether more than scatter is left."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL
from asphalt_nscd.diagnosis.content.doubts import ITSELF, LEFT_OUT
from asphalt_nscd.diagnosis.criteria import ALPHA_PER_STEP
from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.apart import STANDS_OUT
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.words.sentences import cause_words, numbers, spell_cause
from asphalt_nscd.diagnosis.written import interval_text, mean_averages, name_at
from asphalt_nscd.files.words import joined, specimen_named

Content = Mapping[str, Any]
LAW = "relaxation_spectrum"
EFFECTS = {cause.name for cause in CATALOGUE if cause.stage == MATERIAL and not cause.confined_to}
ALTERING = {cause.name for cause in CATALOGUE if cause.alters_tests}
OF_THE_MIX = EFFECTS | {LAW, BOND_MAPPING}
FIT_WORSE = 1.05  # times the misfit without a cause, from which it is told that the cause does not help
WORSE, AT_ALL = 1.1, 0.5  # times an error of before, and percent more, at which a law has made it worse
MANY_SPECIMENS = 5  # from here on one odd specimen hardly moves the common curve
# The number in a sentence of `quality`, as in `load uniformity 12.3 % (limit 10 %)`.
QUALITY_VALUE = re.compile(r"(?<= )\S+(?= \S+ \(limit )")
SAME = 1e-3  # relative difference of errors of one law


def unused_tests(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis left out, in their order."""
    return [one for one in content["suspect_tests"] if one["status"] == LEFT_OUT]


def doubtful_tests(content: Content) -> list[Content]:
    """Tests that their own isotherm speaks against and that the diagnosis used all the same, in their order."""
    tests = content["suspect_tests"]
    return [one for one in tests if ITSELF in one["decided_by"] and one["status"] != LEFT_OUT]


def grouped_tests(tests: Sequence[Content]) -> list[tuple[str, float, list[str], list[float]]]:
    """Tests of one specimen and isotherm with the same reasons: specimen, degC, reasons and frequencies [Hz].

    Values of a quality column that differ are told from the least to the largest.
    """
    alike: dict[tuple[str, float, tuple[str, ...]], list[Content]] = {}
    for one in tests:
        kinds = tuple(QUALITY_VALUE.sub("{}", reason) for reason in one["reasons"])
        alike.setdefault((one["specimen"], one["temperature_C"], kinds), []).append(one)
    return [
        (
            specimen,
            at,
            [_together([one["reasons"][k] for one in own]) for k in range(len(kinds))],
            sorted({one["frequency_Hz"] for one in own}),
        )
        for (specimen, at, kinds), own in alike.items()
    ]


def _together(reasons: Sequence[str]) -> str:
    """One reason for several that differ in the value of a quality column at most."""
    values = sorted({value for reason in reasons for value in QUALITY_VALUE.findall(reason)}, key=float)
    return QUALITY_VALUE.sub(" to ".join([*values[:1], *values[1:][-1:]]), reasons[0])


def rungs_of(content: Content, kind: str) -> list[Content]:
    """Named causes: a "fault" of the tests, or an "effect" of the mix beside its relaxation, in the ladder's order."""
    ladder = content["ladder"]
    if kind == "fault":
        return [rung for rung in ladder if rung["cause"] not in OF_THE_MIX]
    return [rung for rung in ladder if rung["cause"] in EFFECTS]


def rivalled_by_a_fault(effects: Sequence[Content]) -> bool:
    """Whether a fault of the tests fits as well as one of these effects of the mix."""
    rivals = (name for rung in effects for name in rung["as_good"])
    return any(name.partition(" @ ")[0] not in OF_THE_MIX for name in rivals)


def rivals(rung: Content, content: Content, named: bool = False) -> list[str]:
    """Causes that fit as well as a name, in words: those that were not `named`, or those that were."""
    known = {name_at(one["cause"], one["where"]) for one in content["ladder"]}
    return [spell_cause(name) for name in rung["as_good"] if (name in known) == named]


def worsens(rung: Content) -> bool:
    """Whether the tests, counted alike, fit worse with a cause than without it."""
    fits = rung["gain"]["in_sample"].get("rms_over_scatter")
    return bool(fits) and fits["after"] > FIT_WORSE * fits["before"]


def changed(content: Content, key: str) -> tuple[list[str], list[str], bool]:
    """Causes that another choice of tests would name more, those it would not, and whether it names others too."""
    now = [cause_words(rung) for rung in content["ladder"] if rung["cause"] not in (BOND_MAPPING, LAW)]
    then = [cause_words(rung) for rung in content[key]["causes"] if rung["cause"] != LAW]
    more = [name for name in then if name not in now]
    return more, [name for name in now if name not in then], len(more) < len(then)


def exceeds_scatter(content: Content) -> bool:
    """Whether named causes leave structure, by lack of fit or largest pattern left, at half a step's chance each."""
    return content["lack_of_fit_p_value"] <= 0.5 * ALPHA_PER_STEP or pattern_stands_out(content)


def pattern_stands_out(content: Content) -> bool:
    """Whether the largest pattern that causes leave is itself no chance."""
    pattern = content["largest_pattern_left"]
    return pattern is not None and bool(pattern["p_value"] <= 0.5 * ALPHA_PER_STEP)


def parts_left(content: Content) -> list[Content]:
    """Parts of what no cause explains, largest first."""
    return sorted(content["discrepancy"], key=lambda one: -float(one["size"]))


def too_few_to_tell(content: Content, most: int) -> bool:
    """Whether one of the `most` largest parts left is of a specimen, of too few to tell which one is odd.

    Of few specimens each has a large part in the common curve that it is compared with.
    """
    few = 1 < len(content["reading"]["specimens"]) < MANY_SPECIMENS
    return few and any(one["specimen"] is not None for one in parts_left(content)[:most])


def exceeded(content: Content, tests: int) -> list[tuple[quality.Limit, list[str]]]:
    """Limits of the standard that half of all `tests`, or of those of a specimen, exceed; in which, in words."""
    above, found = content["reading"]["limits_exceeded"], []
    share = tests / len(content["reading"]["specimens"])  # which were tested alike
    for name, limit in quality.LIMITS.items():
        of = [one["specimen"] for one in above if one["column"] == name]
        counts = {specimen: of.count(specimen) for specimen in of}
        if of and (2 * len(of) >= tests or 2 * max(counts.values()) >= share):
            where = [f"{count} of {specimen_named(name)}" for name, count in counts.items()]
            found.append((limit, [where[0].replace(" of ", " tests of ", 1), *where[1:]]))
    return found


def held_back(content: Content) -> list[str]:
    """What law.json and reported.csv are made without until a check clears it, in words; empty where nothing is."""
    if not content["trust"]["held_back"]:
        return []
    highest = content["highest_frequency"]
    at = [] if highest is None else [f"the tests at {highest['frequency_Hz']:g} Hz"]
    odd_in = (content[f"odd_{of}"] for of in ("levels", "phases", "temperatures"))
    return [*levels.places(*odd_in), *at]


def misses(
    content: Content, left: Mapping[str, float] | None, in_degrees: bool
) -> tuple[list[float], list[float]]:
    """Errors of |E*| [%] and phase, mean over temperatures, before the first rung of the ladder and after the last.

    That of the phase is in percent of it, as in Table 4, or `in_degrees`. `left`: errors of "E" and "phase" [%] that
    tests simulated with the law have left; else those of the diagnosis.
    """
    names = ("mre_E_percent", "off_phase_deg" if in_degrees else "mre_phase_percent")
    first, last = (mean_averages(content["ladder"][k]["gain"]["in_sample"]) for k in (0, -1))
    after = [last[name]["after"] for name in names] if left is None else [left["E"], left["phase"]]
    return [first[name]["before"] for name in names], after


def made_worse(before: Sequence[float], after: Sequence[float]) -> list[str]:
    """Which errors, of |E*| and of the phase, are larger after than before, by more than both WORSE and AT_ALL."""
    pairs = zip(("|E*|", "the phase"), before, after, strict=True)
    return [part for part, was, now in pairs if now > max(WORSE * was, was + AT_ALL)]


def begins_with_one_law(content: Content) -> bool:
    """Whether the ladder begins with one law that is no rung, as of too few tests to tell it, not with Burgers laws.

    The errors before its first rung are then not those of the Burgers laws.
    """
    first = content["ladder"][0]
    if first["cause"] == LAW:
        return False
    had = mean_averages(first["gain"]["in_sample"])["mre_E_percent"]["before"]
    burgers = list(content["baseline"]["mre_E_percent"].values())
    return abs(had - sum(burgers) / len(burgers)) >= SAME * had


def contradictions(content: Content) -> list[tuple[str, list[float], list[str]]]:
    """Sides to which the phase contradicts |E*|: "higher" or "lower", where [degC], and the most in words."""
    found = []
    for side, sign in (("higher", 1.0), ("lower", -1.0)):
        here = [one for one in content["contradictory_isotherms"] if sign * one.get("worst_deg", 0.0) > 0.0]
        here = [one for one in here if "offset_deg" not in one]
        most = [f"{abs(one['worst_deg']):.1f} deg (at {one['worst_Hz']:g} Hz)" for one in here]
        found += [(side, [one["temperature_C"] for one in here], most)] * bool(here)
    return found


def has_fault_of_one_place(content: Content) -> bool:
    """Whether a fault of one specimen, isotherm or frequency was found beside the last fit."""
    keys = ("odd_phases", "odd_temperatures", "contradictory_isotherms")
    told = any("probability" in one for key in keys for one in content[key])
    # An odd level has no probability of its own.
    return told or bool(content["odd_levels"]) or content["highest_frequency"] is not None


def odd(content: Content) -> list[str]:
    """What is odd and what to check, a sentence each; what explains two departures comes before them."""
    moduli, phases, temperatures = (content[f"odd_{of}"] for of in ("levels", "phases", "temperatures"))
    return [
        *levels.swap_notes(moduli, temperatures),
        *levels.temperature_notes(temperatures),
        *levels.sentences(moduli, phases),
    ]


def whole_specimens(content: Content) -> list[str]:
    """Specimens whose phase is odd in all tests."""
    return [one["specimen"] for one in content["odd_phases"] if one["temperature_C"] is None]


def stands_out(content: Content) -> Content | None:
    """The specimen that is told to stand out, where nothing else that is said of it explains why."""
    one = content["repeatability"] and content["repeatability"]["furthest"]
    if not one or max(one["E_over_usual"], one["kelvin_over_usual"]) < STANDS_OUT:
        return None
    told = [odd["specimen"] for of in ("levels", "phases", "temperatures") for odd in content[f"odd_{of}"]]
    return None if one["specimen"] in [*told, *(rung["where"] for rung in content["ladder"])] else one


def fit_as_well(rungs: Sequence[Content], content: Content) -> bool:
    """Whether anything fits as well as one of these names."""
    return any(rivals(rung, content) for rung in rungs)


def highest_departure(one: Content) -> str:
    """By how much all tests at the highest frequency are off, in words."""
    parts = []
    for name, key, unit in (("|E*|", "modulus_percent", "%"), ("the phase", "phase_deg", "deg")):
        low, high = one[f"{key.split('_')[0]}_interval_95"]
        if low > 0.0 or high < 0.0:
            side = "above" if one[key] > 0.0 else "below"
            parts.append(f"{name} is {interval_text(abs(one[key]), 0.5 * (high - low))} {unit} {side}")
    return joined(parts) or "|E*| and phase are off"


def sole_specimen(trust: Content) -> str:
    """Words for the only specimen of several with tests that can be used; empty where more have some."""
    of = [name for name, count in trust["use_by_specimen"].items() if count]
    return f" (of {specimen_named(of[0])} only)" if len(of) == 1 < len(trust["use_by_specimen"]) else ""


def all_of(trust: Content) -> str:
    """Words for what all tests to be checked have in common, isotherms or specimens; else empty."""
    if trust["check_at_C"]:
        return f" (all at {numbers(trust['check_at_C'])} degC)"
    return f" (all of {joined(list(map(specimen_named, trust['check_of'])))})" if trust["check_of"] else ""
