"""The answer of a diagnosis on one screen: what to use, what to correct, what to leave out, what to test next;
then how far it goes.

Rows of a label and sentences, for the terminal and for the head of the page; the reasons stand in `summary` and on the
page.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from textwrap import wrap

from asphalt_nscd.diagnosis.criteria import LEAST_ISOTHERMS
from asphalt_nscd.diagnosis.next_tests.fixed_orders import HALF, MANY, band
from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.words import sentences, unexplained, verdict
from asphalt_nscd.diagnosis.words.sentences import Content, cause_words, doubtful, odd, unused_tests
from asphalt_nscd.diagnosis.written import interval_text
from asphalt_nscd.files.words import counted, joined, specimen_named
from asphalt_nscd.measurements.campaign import OFF_TARGET
from asphalt_nscd.measurements.kinds import UNKNOWN

Rows = list[tuple[str, list[str]]]

WIDTH, LABEL = 100, 16  # columns of a terminal, and those of them for labels
MOST = 4  # sentences of a row; a reader finds the others in the reasons
PARTS = 2  # of what stays unexplained
FEW = 6  # specimens that are named one by one
_wrapped = partial(wrap, width=WIDTH, break_long_words=False, break_on_hyphens=False)
AVERAGED = "values of the mix weigh {}; corrected tests keep it."
MORE = "{} more: see the reasons."
TYPE_NOT_GIVEN = (
    "Test type not given: faults of one apparatus alone, such as a moving mass, were not looked for. Say whether it "
    "was bending or tension-compression: by --measured-in, or in the menu of the page."
)
TEMPERATURES_TAKEN = (
    "All this takes the recorded temperatures for right. Some are off their target: see Check first."
)
NO_QUALITY_COLUMNS = "There are no quality columns: tests are judged by modulus and phase alone."


def rows(content: Content, left: Mapping[str, float] | None = None) -> Rows:
    """Label and sentences of each row in reading order, empty rows left out; `left` as in `verdict.simulation_miss`."""
    simulated = left is not None or verdict.bonded(content)
    certain, possible = (_told(verdict.faults(content), content, wanted) for wanted in (True, False))
    effects, likely = (_told(verdict.effects(content), content, wanted) for wanted in (True, False))
    a_fault = bool(possible) or verdict.rivalled_by_a_fault(content)
    found: Rows = [
        ("Tests", _tests(content)),
        ("Note", _notes(content)),
        ("Data", _data(content)),
        ("Fault", certain or _lack_of_certainty(content, a_fault, bool(effects))),
        ("Possible fault", possible),
        ("Effect", effects),
        ("Possible effect", likely),
        ("Leave out", [*_few(_doubts_by_isotherm(unused_tests(content))), *_if_kept(content)]),
        ("Check first", [*_few(_check(content)), *_what_clears(content)]),
        ("Next tests", _next(content)),
        ("Not visible", unexplained.unseen(content)),
        ("Scatter", _scatter(content)),
        ("Simulation" if simulated else "Law", _law(content, left, simulated)),
        ("Unexplained", _unexplained(content)),
    ]
    return [(label, said) for label, said in found if said]


def text(content: Content) -> str:
    """The rows as text of WIDTH columns: labels first, a blank line before the next tests and after them."""
    told, lines, above = rows(content), [], ""
    for label, said in told:
        if "Next tests" in (label, above):
            lines.append("")
        above = label
        for k, sentence in enumerate(said):
            first = f"{label if k == 0 else '':{LABEL}}"
            after = " " * (LABEL + 3 * (label == "Next tests"))
            lines += _wrapped(sentence, initial_indent=first, subsequent_indent=after)
    return "\n".join(lines)


def sure(rung: Content) -> bool:
    """Whether a cause is established, not merely possible."""
    return bool(rung["established"])


def _told(rungs: list[Content], content: Content, certain: bool) -> list[str]:
    """Named causes that are certain, or those that are not and improve the fit."""
    alike = [rung for rung in rungs if sure(rung) == certain]
    return [_fault(rung, content) for rung in alike if certain or not sentences.worsens(rung)]


def _sentence(words: str) -> str:
    return sentences.capital(words).rstrip(".") + "."


def _few(said: list[str]) -> list[str]:
    """The first of many sentences, and how many more there are."""
    return said if len(said) <= MOST else [*said[: MOST - 1], MORE.format(len(said) - MOST + 1)]


def _tests(content: Content) -> list[str]:
    read = content["reading"]
    names = read["specimens"]
    which = counted(len(names), "specimen")
    if len(names) <= FEW:
        which = f"specimen{'s' * (len(names) > 1)} {joined(names)}"
    at = joined([f"{t:g}" for t in read["isotherms_C"]])
    return [_sentence(f"{verdict.TESTS_OF[read['test_type']]}: {which} at {at} degC")]


def _notes(content: Content) -> list[str]:
    """What a reader must know before all else."""
    read = content["reading"]
    no_columns = read["test_type"] == "tension-compression" and not read["quality_columns"]
    gaps = joined(read["not_tested"])
    said = [
        verdict.mixes(content),
        verdict.files(content),
        TYPE_NOT_GIVEN * (read["test_type"] == UNKNOWN),
        TEMPERATURES_TAKEN * bool(read["off_target"]),
        *(sentences.origin(content) if content["origin"] != "measured" else []),
        NO_QUALITY_COLUMNS * no_columns,
        f"Not tested: {gaps}." * bool(gaps),
    ]
    return list(filter(None, said))


def _data(content: Content) -> list[str]:
    """How many tests can be used, how many only after a check, how many not."""
    tests, out = content["tests"], len(unused_tests(content))
    trust = content["trust"]
    everywhere = any(sure(rung) and rung["where"] is None for rung in verdict.faults(content))
    corrected = " after correction" * (everywhere and trust["use"] > 0)
    if not trust["check"] and not trust["not_used"]:
        return [f"All {tests} tests can be used{corrected}."]
    of = [name for name, count in trust["use_by_specimen"].items() if count]
    alone = f" (of {specimen_named(of[0])} only)" if len(of) == 1 < len(trust["use_by_specimen"]) else ""
    parts = [f"{trust['use'] or 'None'} of {tests + out} tests can be used{corrected}{alone}"]
    at = ""
    if trust["check_at_C"]:
        at = f" (all at {joined([f'{t:g}' for t in trust['check_at_C']])} degC)"
    elif trust["check_of"]:
        at = f" (all of {joined(list(map(specimen_named, trust['check_of'])))})"
    parts += [f"{trust['check']} only if a check clears them{at}"] * bool(trust["check"])
    parts += [f"{trust['not_used']} cannot"] * bool(trust["not_used"])
    phases = [
        "Use their |E*| now. Most phases lie on one side of what |E*| requires: use them after the test on metal, less "
        "the phase of metal."
    ] * bool(content["one_sided"])
    return [" ".join([f"{', '.join(parts)}.", *phases])]


def _lack_of_certainty(content: Content, possible: bool, effects: bool) -> list[str]:
    """That none is certain, and how many temperatures certainty lacks; effects: whether any of the mix is certain."""
    confined = ("odd_phases", "odd_temperatures", "contradictory_isotherms")
    checks = any("probability" in one for key in confined for one in content[key])
    checks |= content["highest_frequency"] is not None
    beside = ["what is to be checked first"] * checks + ["the effect below"] * effects
    said = "None is certain" if possible else "None found" + f" beside {joined(beside)}" * bool(beside)
    at = len(sentences.isotherms(content))
    if 0 < at < LEAST_ISOTHERMS:
        there = f"there {'is' if at == 1 else 'are'} {at}"
        said += f", and none could be proved: that takes {LEAST_ISOTHERMS} temperatures, and {there}"
    return [f"{said}."]


def _fault(rung: Content, content: Content) -> str:
    """A named cause: its size, where it is, what it or its sign means, what to do about it."""
    size = sentences.size(rung, content)
    everywhere = " in all tests" * (rung["where"] is None)
    of_the_mix = rung["cause"] in verdict.OF_THE_MIX
    meaning = _sentence(rung["sentence"]) if of_the_mix else sentences.meaning(rung).strip()
    said = [_sentence(f"{cause_words(rung)}{everywhere}{f', {size}' * bool(size)}")]
    if not sure(rung):
        rivals = sentences.rivals(rung, content)
        ways = joined(["it", *rivals, "neither" if len(rivals) == 1 else "none of them"])
        weighed = f"{ways}, by probability" if rivals else "both, with it and without"
        said += [f"If so, {meaning[:1].lower()}{meaning[1:]}"] * bool(meaning)
        said += [f"Not certain: {joined(rivals, 'or')} fits as well."] * bool(rivals)
        said.append(f"Its probability is {sentences.probability(rung)}: {AVERAGED.format(weighed)}")
    elif of_the_mix:
        free = "law.json is free of it" + "; corrected tests keep it" * (not verdict.taken_off(rung))
        said += [meaning, f"{free}." * (content["law_misses"] is not None)]
    else:
        correction = verdict.correction(rung)
        said += [meaning, f"Correction: {correction}." * bool(correction)]
    return " ".join(filter(None, said))


def _if_kept(content: Content) -> list[str]:
    """What would be named with the tests left out, where that is something else."""
    changed = sentences.only_with_suspects(content)
    return [f"{changed.rstrip('.')}, but they cannot be trusted."] if changed else []


def _doubts_by_isotherm(tests: list[Content]) -> list[str]:
    """Why tests are doubtful, those of one isotherm with the same reasons in one sentence."""
    alike: dict[tuple, list[Content]] = {}
    for one in tests:
        alike.setdefault((one["specimen"], one["temperature_C"], tuple(one["reasons"])), []).append(one)
    return [
        _sentence(
            f"{specimen_named(specimen)}, {t:g} degC, {band(sorted({one['frequency_Hz'] for one in here}))}: "
            f"{'; '.join(reasons)}"
        )
        for (specimen, t, reasons), here in alike.items()
    ]


def _check(content: Content) -> list[str]:
    """What is doubtful, where, and what to check."""
    read, tests = content["reading"], content["tests"] + len(unused_tests(content))
    said = _contradictions(content["contradictory_isotherms"])
    said += [
        _sentence(
            f"{specimen_named(one['specimen'])} at {one['temperature_C']:g} degC: measured at {one['measured_C']:g} "
            f"degC, {abs(one['measured_C'] - one['temperature_C']):.2g} K off its target "
            f"(AASHTO T 378 allows {OFF_TARGET:g} K). Look for a slip in the record, else test again"
        )
        for one in read["off_target"]
    ]
    above = read["limits_exceeded"]
    for name, limit in quality.LIMITS.items():
        here = [one for one in above if one["column"] == name]
        of = [one["specimen"] for one in here]
        most = max(map(of.count, of), default=0)
        if 2 * len(here) >= tests or 2 * most * len(read["specimens"]) >= tests > 0 < most:
            said.append(
                f"{limit.label.capitalize()} is above {limit.limit:g} {limit.unit} in "
                f"{_where_exceeded(here, content)}. Check {limit.check}."
            )
    warmer = content["odd_temperatures"]
    # What explains both comes before the two that it explains, of which a screen may not hold all.
    said += [_sentence(one) for one in levels.swap_notes(odd(content)[0], warmer)]
    said += [_sentence(one) for one in levels.temperature_notes(warmer)]
    said += [_sentence(one) for one in levels.sentences(*odd(content))]
    said += _highest_frequency_check(content)
    return said + _doubts_by_isotherm(doubtful(content))


def _highest_frequency_check(content: Content) -> list[str]:
    """What all tests at the highest frequency are off by, and what to check."""
    one = content["highest_frequency"]
    if one is None:
        return []
    parts = []
    for name, key, unit in (("|E*|", "modulus_percent", "%"), ("the phase", "phase_deg", "deg")):
        low, high = one[f"{key.split('_')[0]}_interval_95"]
        side = "above" if one[key] > 0.0 else "below"
        if low > 0.0 or high < 0.0:
            parts.append(f"{name} is {interval_text(abs(one[key]), 0.5 * (high - low))} {unit} {side}")
    off = f"{' and '.join(parts) or '|E*| and phase are off'} what the other frequencies ask for"
    return [
        f"In all tests at {one['frequency_Hz']:g} Hz {off}. Check that this frequency is the true one and that a cycle "
        "has enough samples, then test there again."
    ]


def _what_clears(content: Content) -> list[str]:
    """The result of a check that makes doubtful tests usable."""
    broken = [one["temperature_C"] for one in content["contradictory_isotherms"]]
    trust = content["trust"]
    if not trust["check"] or (broken and trust["check_at_C"] == broken):
        return []
    return [
        f"Repeat {'any other' if broken else 'a'} doubtful test after the check. If both agree"
        f"{_repeatability_limit(content)}, keep the old one, else use the new."
    ]


def _repeatability_limit(content: Content) -> str:
    """Between two tests of one specimen, 95 % of the differences: 2.8 standard deviations (ISO 5725-6)."""
    within = (content["repeatability"] or {}).get("within")
    if within is None:
        return ""
    modulus, phase = (f"{2.8 * within[part]:.2g}" for part in ("E_percent", "phase_deg"))
    return f" within {modulus} % in |E*| and {phase} deg in phase"


def _where_exceeded(above: list[Content], content: Content) -> str:
    """`all tests of specimens A and B and 3 of specimen C at 4 degC`; specimens were tested alike."""
    specimens = content["reading"]["specimens"]
    tests = content["tests"] + len(unused_tests(content))
    places: dict[str, list[Content]] = {}
    for one in above:
        places.setdefault(one["specimen"], []).append(one)
    whole = [name for name, at in places.items() if len(at) * len(specimens) == tests]
    parts = []
    if whole:
        named = specimen_named(whole[0]) if len(whole) == 1 else f"specimens {joined(whole)}"
        parts.append(f"all tests of {named}")
    for name, at in places.items():
        if name not in whole:
            place = ""
            if len({one["temperature_C"] for one in at}) == 1:
                place = f" at {at[0]['temperature_C']:g} degC"
                if len(at) < FEW:
                    place += f" ({joined([f'{f:g}' for f in sorted(one['frequency_Hz'] for one in at)])} Hz)"
            parts.append(f"{len(at)} {'' if parts else 'tests '}of {specimen_named(name)}{place}")
    return ", in ".join(parts)


def _contradictions(found: list[Content]) -> list[str]:
    """Where isotherms contradict themselves most, what to check, and which tests to use then."""
    again = "then test there again. If phase and slope then agree, use the new tests in place of the old."
    turned = [one for one in found if "offset_deg" in one]
    said = []
    for side in ("higher", "lower"):
        here = [one for one in found if one not in turned and (one["worst_deg"] > 0.0) == (side == "higher")]
        if here:
            at = joined([f"{one['temperature_C']:g}" for one in here])
            most = joined([f"{abs(one['worst_deg']):.1f} deg (at {one['worst_Hz']:g} Hz)" for one in here])
            said.append(
                f"At {at} degC the phase is up to {most} {side} than |E*| requires (about 90 deg times the slope "
                f"of log |E*| against log f). Check strain level, load control and gauges, {again}"
            )
    look = "Check the channels and their settings there"
    return said + [f"{one['sentence']} {look}, {again}" for one in turned]


def _scatter(content: Content) -> list[str]:
    found = content["repeatability"] or {}
    within = "within one specimen, after removing its mean deviation"
    said = [
        f"{words}: {found[way]['E_percent']:.1f} % in |E*|, {found[way]['phase_deg']:.1f} deg in phase"
        for way, words in (("between", "between specimens"), ("within", within))
        if found.get(way) is not None
    ]
    return [f"Standard deviation {'; '.join(said)}."] if said else []


def _law(content: Content, left: Mapping[str, float] | None, simulated: bool) -> list[str]:
    """What the law misses, and of what it was made."""
    misses = content["law_misses"]
    if simulated or misses is None:
        return [_sentence(verdict.simulation_miss(content, left))]
    modulus, phase = (f"{misses[name]:.2g}" for name in ("mre_E_percent", "mre_phase_percent"))
    title = next((one["title"] for one in content["laws"] if one["taken"]), "2S2P1D")
    said = [
        f"law.json, a {title} master curve, is off {verdict.held_against(content)} by {modulus} % in |E*| and {phase} "
        "% of the phase angle."
    ]
    if sentences.alone(content):
        said.append("Without replicates nobody knows how much of that is scatter.")
    corrected = any(sure(rung) and verdict.taken_off(rung) for rung in content["ladder"])
    out = verdict.held_back(content)
    doubtful = content["trust"]["check"] and not out
    but = " but those left out" * bool(unused_tests(content))
    if corrected or out:
        without = f" without {joined(out)}" if out else ""
        among = ", doubtful ones too" * bool(doubtful)
        said.append(f"It was fitted to the{' corrected' * corrected} tests{without}{among}.")
    elif doubtful:
        said.append(f"It was fitted to all tests{but}, doubtful ones too.")
    said += filter(None, [content["undetermined"]])
    return [" ".join(said)]


def _unexplained(content: Content) -> list[str]:
    # An isotherm that contradicts itself is told under what to check first.
    broken = [one["temperature_C"] for one in content["contradictory_isotherms"]]
    of_others = [one for one in content["discrepancy"] if one["temperature_C"] not in broken]
    told = sentences.exceeds_scatter(content) and bool(of_others or not content["discrepancy"])
    parts = unexplained.left({**content, "discrepancy": of_others})[:PARTS] if told else []
    remarks = unexplained.remarks(content, PARTS) if parts and content["discrepancy"] else []
    off = "the common master curve is off by " if content["discrepancy"] else ""
    said = [f"Beyond scatter, {off}{part}" for part in parts if part not in remarks]
    return [*filter(None, [content["one_sided"]]), *map(_sentence, [*said, *remarks])]


def _next(content: Content) -> list[str]:
    """The orders, numbered, each with its hours and purpose; none for data that no laboratory made."""
    if "reconstructed" in content["origin"]:
        return []
    orders = content["instructions"]["orders"]
    said = []
    for number, one in enumerate(orders, 1):
        tested = one["frequencies_Hz"]
        at = "all frequencies" if len(tested) >= MANY else band(tested)
        act = f"{one['act']}, {at}{HALF * one['half_strain']}"
        why = f", {one['purpose']}" * bool(one["purpose"])
        cost = f" ({one['hours']:.1f} h)" if one["hours"] > 0.0 else ""
        said.append(f"{number}. {_sentence(f'{act}{why}{cost}')}")
    return said
