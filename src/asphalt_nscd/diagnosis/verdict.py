"""What a reader is told first: the test, whether its data can be trusted, and what the simulation misses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from asphalt_nscd.diagnosis import levels, quality
from asphalt_nscd.diagnosis.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL
from asphalt_nscd.diagnosis.sentences import (
    OF_THE_BENCH,
    Content,
    an,
    cause_words,
    in_words,
    more_than_scatter,
    not_used,
    odd,
    place_of_test,
    size,
)
from asphalt_nscd.diagnosis.written import mean_averages, three_digits
from asphalt_nscd.files.words import counted, joined, specimen_named

TEST_TYPES = {
    "bending": "two-point bending of a trapezoidal specimen",
    "tension-compression": "axial test of a cylinder (AMPT or UTM)",
}
ASSUMED = (
    "taken for two-point bending of the specimen of Quezada and Chazallon (2020), since neither --measured-in nor "
    "--geometry was given; for a cylinder give --measured-in tension-compression."
)
OF_THE_MIX = {cause.name for cause in CATALOGUE if cause.stage == MATERIAL and not cause.confined_to} | {
    "relaxation_spectrum",
    BOND_MAPPING,
}
CARRIED = {
    "specimen_geometry": "an error of |E*|, as by wrong dimensions or gauge length,"
}  # causes that are no noun of a fault
SIMPLER = "one Burgers law for each temperature"
COMMON = "one law for all temperatures"
WORSE, AT_ALL = 1.1, 0.5  # times an error of before, and percent more, at which a law has made it worse
MUCH_WORSE, POOR = 2.0, 10.0  # times the error of before, and percent, above which a prediction is warned of
MOST_ODD = 4  # odd isotherms and specimens that are listed
MOST_NAMED = 3  # tests not to be used that the verdict names


def mixes(content: Content) -> str:
    """What a reader must know first: specimens that are hardly of one mix; empty where they may be."""
    spread = (content.get("repeatability") or {}).get("between")
    if spread is None or spread["E_percent"] <= levels.ONE_MIX:
        return ""
    return f"{_spread(spread)}, more than those of one mix do: are there two mixes? Then diagnose each alone."


def on_data(content: Content) -> str:
    """How many tests can be used, which fault they carry, what is odd among them: a sentence each."""
    read = content.get("reading", {})
    parts = [
        _usable(content),
        *levels.sentences(*odd(content))[:MOST_ODD],
        *levels.of_temperatures(content.get("odd_temperatures", [])),
        *_contradictory(content),
        *_flagged(content),
    ]
    if read.get("not_tested"):
        parts.append(
            f"{joined(read['not_tested'])} {'has' if len(read['not_tested']) == 1 else 'have'} no test here"
        )
    faults = _faults(content)
    parts += [_fault(rung, content) for rung in faults]
    spread = (content.get("repeatability") or {}).get("between")
    if spread is not None and not mixes(content):
        parts.append(_spread(spread))
    return " ".join(f"{part[:1].upper()}{part[1:]}." for part in parts)


def _faults(content: Content) -> list[Content]:
    """Named faults of the tests; of a bench that nobody stated, its causes are told with that condition elsewhere."""
    beyond = OF_THE_MIX | (OF_THE_BENCH if content.get("reading", {}).get("bench_assumed") else set())
    return [rung for rung in content["ladder"] if rung["cause"] not in beyond]


def _usable(content: Content) -> str:
    """How many tests can be used as they are, how many only after a check, how many not at all."""
    out, tests, read = len(not_used(content)), content["tests"], content.get("reading", {})
    trust = content.get("trust", {"use": tests, "check": 0, "not_used": out})
    faults = [rung for rung in _faults(content) if rung.get("established", True)]
    corrected = " after correction" if any(rung["where"] is None for rung in faults) else ""
    alone = ""
    if read.get("test_type") == "tension-compression" and not read.get("quality_columns", True):
        alone = "; judged by modulus and phase alone, for there are no quality columns"
    if not trust["check"] and not trust["not_used"]:
        return f"all {tests} tests can be used{corrected}{alone}"
    judged = bool(trust["check"] and _flagged(content))
    can = "pass the limits of the standard" if judged else "can be used"
    only = [name for name, count in trust.get("use_by_specimen", {}).items() if count]
    of_one = f", and all {trust['use']} are of {specimen_named(only[0])}" if judged and len(only) == 1 else ""
    use = f"{trust['use'] or 'none'} of {tests + out} tests {can}{corrected}{of_one}"
    one_isotherm = len(read.get("isotherms_C", [])) == 1
    law = " (the law here is fitted with them)" * (not one_isotherm)
    check = [f"{trust['check']} are doubtful: use them only after a check{law}"] if trust["check"] else []
    named = joined([place_of_test(one) for one in not_used(content)]) if out <= MOST_NAMED else ""
    never = [f"{trust['not_used']} not to be used{f' ({named})' * bool(named)}"] if trust["not_used"] else []
    return "; ".join([use, *check, *never]) + alone


def _contradictory(content: Content) -> list[str]:
    """Isotherms whose modulus and phase contradict each other."""
    broken = [f"{one['temperature_C']:g}" for one in content.get("contradictory_isotherms", [])]
    if not broken:
        return []
    return [
        f"at {joined(broken)} degC modulus and phase contradict each other: check strain and machine there"
    ]


def _flagged(content: Content) -> list[str]:
    """Quality limits that half of the tests exceed or more."""
    tests = content["tests"] + len(not_used(content))
    above = content.get("reading", {}).get("limits_exceeded", [])
    columns = [one["column"] for one in above]
    return [
        f"{columns.count(name)} of {tests} exceed the limit of {limit.label} ({limit.limit:g} {limit.unit}): "
        f"{_most_of(above, name)}. So {limit.check} are in doubt"
        for name, limit in quality.LIMITS.items()
        if 2 * columns.count(name) >= tests
    ]


def _most_of(above: Sequence[Content], column: str) -> str:
    """How many of each specimen."""
    names = [one["specimen"] for one in above if one["column"] == column]
    return joined([f"{names.count(name)} of {specimen_named(name)}" for name in dict.fromkeys(names)])


def _spread(between: Mapping[str, float]) -> str:
    return f"Specimens scatter by {between['E_percent']:.1f} % in |E*| and {between['phase_deg']:.1f} deg in phase"


def _fault(rung: Content, content: Content) -> str:
    """Who carries a fault; perhaps, where the cause itself says why it is not certain."""
    where = rung["where"]
    one = isinstance(where, str)
    who = specimen_named(where) if one else ("all tests" if where is None else f"the tests at {where:g} degC")
    what = CARRIED.get(rung["cause"]) or an(rung["cause"].replace("_", " "))
    told = f"{who} {'shows' if one else 'show'} {what} of {size(rung, content)}"
    if not rung.get("established", True):
        same = [name for name in rung.get("as_good", []) if name.startswith(f"{rung['cause']} @")]
        reason = f"{joined(list(map(in_words, same)), 'or')} fits as well" if same else "the reason is below"
        kept = "" if rung.get("taken_off", True) else ", and left in the data"
        told = f"perhaps {told} (not certain{kept}; {reason})"
        correct = ""
    else:
        tests = "its tests" if one else "them"
        correct = f": {_correction(rung) or f'correct {tests} for it'}"
    return told + correct


def _correction(rung: Content) -> str:
    """What to do to the tests to be rid of a fault, where it is one number."""
    value = next(iter(rung["parameters"].values()))["value"]
    if rung["cause"] == "channel_delay":
        return f"subtract {three_digits(360.0 * value)} deg per Hz from their phases"
    if rung["cause"] == "phase_offset":
        return f"subtract {three_digits(value)} deg from their phases"
    if rung["cause"] == "specimen_geometry":
        return f"if its dimensions prove wrong, divide its |E*| by {three_digits(1.0 + value)}"
    if rung["cause"] == "temperature_bias":
        return f"enter {three_digits(rung['where'] + value)} degC for them"
    return ""


def on_simulation(content: Content, left: Mapping[str, float] | None = None) -> str:
    """One sentence: what the simulation misses with the paper's laws, and with what was found.

    left: errors in percent of "E" and "phase" that tests simulated with it have left; else those of the diagnosis.
    """
    ladder = content["ladder"]
    if not ladder:
        if content["verdict"] != "nothing_to_explain":
            return f"{SIMPLER} leaves more than scatter, and no cause of the catalogue explains it."
        if not content["tested"]:
            return _cannot_judge(content)
        holds = _holding(content)
        return f"{SIMPLER} fits these data to within their scatter{holds or '; nothing is to be explained'}."
    first, last = (mean_averages(rung["gain"]["in_sample"]) for rung in (ladder[0], ladder[-1]))
    names = ("mre_E_percent", "mre_phase_percent")
    missed = [last[name]["after"] for name in names] if left is None else [left["E"], left["phase"]]
    before, after = (
        [f"{three_digits(error)} %" for error in errors]
        for errors in ([first[name]["before"] for name in names], missed)
    )
    facets = ["facets for bonds"] if _bonded(content) else []
    found = joined([*facets, *(_noun(rung) for rung in ladder if rung["cause"] != BOND_MAPPING)])
    simpler = "the simulation of the paper" if facets else _first_law(content)
    worse = _worse([first[name]["before"] for name in names], missed)
    missed_by = "the mean of the specimens" if content["scatter"]["from_replicates"] else "the tests"
    if facets or left is not None:
        return (
            f"{simpler} misses {missed_by} by {before[0]} of |E*| and {before[1]} of the phase; with {found} the "
            f"simulation misses by {after[0]} and {after[1]}, {_beyond_bonds(content)}.{worse}"
        )
    spectrum = any(rung["cause"] == "relaxation_spectrum" for rung in ladder)
    law = COMMON if spectrum else simpler
    found = joined([_noun(rung) for rung in ladder if rung["cause"] != "relaxation_spectrum"])
    without = (
        f" Without {'this cause' if len(ladder) == 1 else 'these causes'} by {before[0]} and {before[1]}."
    )
    return (
        f"{law}{f', with {found},' * bool(found)} misses {missed_by} by {after[0]} of |E*| and {after[1]} of the "
        f"phase, {_beyond_bonds(content)}.{without * (law == simpler)}{_of_the_file(content)}{worse}"
    )


def _noun(rung: Content) -> str:
    """A named cause as a thing that tests show."""
    words = cause_words(rung)
    return an(words.replace("specimen geometry", "error of the dimensions") if rung["where"] else words)


def _of_the_file(content: Content) -> str:
    """How the law that is written was fitted, and what it misses; empty where none is."""
    misses = content.get("law_misses")
    if misses is None:
        return ""
    off = [
        _noun(rung).split(" ", 1)[1]
        for rung in content["ladder"]
        if rung["cause"] not in ("relaxation_spectrum", BOND_MAPPING) and rung.get("taken_off", True)
    ]
    left_in = [rung for rung in content["ladder"] if not rung.get("taken_off", True)]
    without = levels.places(*odd(content))
    how = [f"with the {joined(off)} taken off"] if off else ["to the tests uncorrected"] if left_in else []
    how += [f"without {joined(without)}"] if without else []
    fitted = f", fitted {' and '.join(how)}" if how else ""
    modulus, phase = (three_digits(misses[name]) for name in ("mre_E_percent", "mre_phase_percent"))
    return f" The law to use is law.json: a simpler one (2S2P1D){fitted}, which misses by {modulus} % and {phase} %."


def _bonded(content: Content) -> bool:
    """Whether simulations took part, whose bonds come first among what they missed."""
    return any(rung["cause"] == BOND_MAPPING for rung in content["ladder"])


def answer(content: Content, left: Mapping[str, float] | None = None) -> str:
    """`on_simulation` with what it speaks of, of a table alone only of laws; and where the law is not to be used."""
    simulated = left is not None or _bonded(content)
    where = _predicted_badly(content)
    warning = f" Do not use the law {where}." if where else ""
    return f"{'Simulation' if simulated else 'Law'}: {on_simulation(content, left)}{warning}"


def first_order(content: Content) -> str:
    """What to do first and why; empty where nothing is ordered."""
    orders = content.get("instructions", {"orders": []})["orders"]
    if not orders:
        return ""
    hours, act = orders[0]["text"].removesuffix(".").split(": ", 1)
    why = orders[0]["why"][0].split(". ")[0].removesuffix(".") if orders[0]["why"] else ""
    return f"First: {act}{f' ({hours})' * (orders[0]['hours'] > 0.0)}. {why}.".removesuffix(" .")


def then(content: Content) -> list[str]:
    """What to do after that, a line each; the reasons are told elsewhere."""
    _, *orders = content.get("instructions", {"orders": []})["orders"] or [None]
    return [f"Then, {order['text']}" for order in orders]


def _first_law(content: Content) -> str:
    """The law that the first rung begins with: of too few tests no spectrum is told, but causes rest on one."""
    rung = content["ladder"][0]
    if rung["cause"] == "relaxation_spectrum":
        return SIMPLER
    first = mean_averages(rung["gain"]["in_sample"])["mre_E_percent"]["before"]
    burgers = list(content["baseline"]["mre_E_percent"].values())
    return SIMPLER if abs(first - sum(burgers) / len(burgers)) < 1e-3 * first else COMMON


def _holding(content: Content) -> str:
    """What a scatter holds that is none: it is larger by that, and hides as much."""
    places = levels.places(*odd(content))
    if not places:
        return ""
    are = "is" if len(places) == 1 else "are"
    return f", but that scatter includes {joined(places)}, which {are} odd"


def _worse(before: Sequence[float], after: Sequence[float]) -> str:
    """A warning where a law with fewer parameters misses what it was made for by more."""
    worse = [
        part
        for part, was, now in zip(("|E*|", "the phase"), before, after, strict=True)
        if now > max(WORSE * was, was + AT_ALL)
    ]
    return f" That is more than before in {joined(worse)}: do not use this law." if worse else ""


def _cannot_judge(content: Content) -> str:
    """Why tests without a finding do not say that the simulation is right, and what to add."""
    if content["scatter"]["from_replicates"] or content["provenance"].get("scatter_stated"):
        return (
            "Two frequencies cannot judge a law: a Burgers law fits them exactly, whatever is wrong. Test at "
            "three frequencies or more."
        )
    alone = len(content.get("reading", {}).get("specimens", [])) == 1
    lacking = "One specimen" if alone else "Specimens without a common temperature and frequency"
    add = "Test a second one at the same conditions" if alone else "Test two at the same conditions"
    return (
        f"{lacking} cannot judge a law: nothing was found, but the scatter from test to test is not known. "
        f"{add}, or state the scatter."
    )


def _beyond_bonds(content: Content) -> str:
    """Whether more than scatter is left, once what the simulated bonds add to their law is taken off."""
    if not content["tested"] and _alone(content):
        return "and nobody knows how much of that is scatter"
    fits = content["verdict"] == "explained" or not more_than_scatter(content)
    named = [rung for rung in content["ladder"] if rung["cause"] not in ("relaxation_spectrum", BOND_MAPPING)]
    sure = all(rung.get("established", True) for rung in named)
    within = " within specimens" if content["scatter"]["from_replicates"] else ""
    scatter = "no more than scatter can explain" if fits else f"more than scatter{within} can explain"
    by = "" if sure or not fits else ", but not every cause is certain"
    by += _holding(content) if fits else "" if named else ", and no cause was found"
    bonds = content["numerics"]["largest_modulus_percent"]
    if bonds <= content["scatter"]["modulus_percent"]:
        return f"{scatter}{by}"
    added = f"of which the simulated bonds add up to {bonds:.1f} % to |E*|"
    return f"{added}; the rest is {scatter}{by}"


def _alone(content: Content) -> bool:
    """Whether nothing tells the scatter: one specimen, and none was stated."""
    return not content["scatter"]["from_replicates"] and not content["provenance"].get("scatter_stated")


def _left_out(content: Content) -> tuple[dict[float, float], float] | None:
    """Errors of |E*| in percent of each isotherm predicted from the others, and their mean between the two ends."""
    rungs = content["ladder"]
    gain = rungs[-1]["gain"].get("held_out", {}).get("leave_one_isotherm_out") if rungs else None
    if gain is None:
        return None
    errors = {float(t): one["mre_E_percent"]["after"] for t, one in gain["averages_by_temperature"].items()}
    return errors, mean_averages(gain, inner=True)["mre_E_percent"]["after"]


def _predicted_badly(content: Content) -> str:
    """Where the law predicts temperatures that were left out of its fit badly, between others or beyond; else empty."""
    found = _left_out(content)
    if found is None:
        return ""
    errors, between = found
    if between > POOR:
        return "at temperatures that were not tested"
    return "beyond the tested temperatures" if max(errors[min(errors)], errors[max(errors)]) > POOR else ""


def beyond_the_tests(content: Content) -> list[str]:
    """How far off the law is at temperatures left out of its fit, where that forbids to use it there."""
    found = _left_out(content)
    if found is None or not _predicted_badly(content):
        return []
    errors, between = found
    coldest, warmest = min(errors), max(errors)
    inner = sorted({*errors} - {coldest, warmest})
    between_them = f"at {inner[0]:g} degC" if len(inner) == 1 else "between them"
    return [
        "Each temperature predicted from the others: |E*| is off by "
        + ", ".join(
            f"{_two(errors[t])} % at {t:g} degC{' (where these tests are doubtful)' * _wrong(t, content)}"
            for t in (coldest, warmest)
        )
        + f" and {_two(between)} % {between_them}."
    ]


def _two(error: float) -> str:
    return f"{float(f'{error:.2g}'):g}"


def _wrong(temperature: float, content: Content) -> bool:
    """Whether a cause is named at an isotherm, or the isotherm contradicts itself."""
    broken = [one["temperature_C"] for one in content.get("contradictory_isotherms", [])]
    return temperature in [*broken, *(rung.get("where") for rung in content["ladder"])]


def predicts_badly(gain: dict[str, Any], inner: bool) -> bool:
    """Whether what is left out is predicted much worse than before, which may have seen it; inner: between others."""
    found = mean_averages(gain, inner)
    return any(errors["after"] > max(MUCH_WORSE * errors["before"], POOR) for errors in found.values())


def test_type(content: Content) -> str:
    """The test, its specimens and its isotherms."""
    read = content.get("reading")
    if read is None:
        return ""
    at = joined([f"{t:g}" for t in read["isotherms_C"]])
    tests = f"{counted(len(read['specimens']), 'specimen')}, {at} degC"
    return f"{ASSUMED} {tests}" if read.get("bench_assumed") else f"{TEST_TYPES[read['test_type']]}, {tests}"


def files(content: Content) -> str:
    """Which files of a folder gave no test; empty where all did."""
    return " ".join(content.get("reading", {}).get("files_without_tests", []))
