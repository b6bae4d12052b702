"""What a diagnosis says in plain sentences, for the terminal and for the page alike.

Units are written as on a terminal (degC, deg, +-); the page sets them in type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from asphalt_nscd.diagnosis import levels, quality
from asphalt_nscd.diagnosis.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL
from asphalt_nscd.diagnosis.chance import CHANCE
from asphalt_nscd.diagnosis.written import CONFIDENCE, mean_averages, shown, three_digits
from asphalt_nscd.files.words import counted, specimen_named

Content = Mapping[str, Any]
TEST_TYPES = {
    "bending": "two-point bending of a trapezoidal specimen",
    "tension-compression": "axial test of a cylinder (tension-compression, AMPT or UTM)",
}
ASSUMED = (
    "taken for two-point bending of the paper's specimen, since neither --measured-in nor --geometry was given; for a "
    "cylinder give --measured-in tension-compression."
)
SIGNS = {cause.name: cause.signs for cause in CATALOGUE if cause.signs is not None}
BOUNDS = {
    cause.name: [x for x in (cause.parameters[0].low, cause.parameters[0].high) if x] for cause in CATALOGUE
}
OF_THE_MIX = {cause.name for cause in CATALOGUE if cause.stage == MATERIAL and not cause.confined_to} | {
    "relaxation_spectrum",
    BOND_MAPPING,
}
OF_THE_BENCH = {cause.name for cause in CATALOGUE if "tension-compression" not in cause.benches}
SIMPLER = "one Burgers law for each temperature"
COMMON = "one law for all temperatures"
WORSE, AT_ALL = 1.1, 0.5  # times an error of before, and percent more, at which a law has made it worse
LARGEST = 4  # parts of what stays unexplained that are listed


def mixes(content: Content) -> str:
    """What a reader must know first: specimens that are hardly of one mix; empty where they may be."""
    spread = (content.get("repeatability") or {}).get("between")
    if spread is None or spread["E_percent"] <= levels.ONE_MIX:
        return ""
    return f"{_spread(spread)}, more than those of one mix do: are there two mixes? Then diagnose each alone."


def on_data(content: Content) -> str:
    """How many tests can be used, which fault they carry, which isotherm contradicts itself: a sentence each."""
    out = len(not_used(content))
    tests = content["tests"]
    parts = [f"{tests} of {tests + out} tests can be used" if out else f"all {tests} tests can be used"]
    parts += _flagged(content)
    parts += [_fault(rung) for rung in content["ladder"] if rung["cause"] not in OF_THE_MIX]
    spread = (content.get("repeatability") or {}).get("between")
    if spread is not None and not mixes(content):
        parts.append(_spread(spread))
    parts += levels.sentences(*_odd(content))[:LARGEST]
    broken = [one["temperature_C"] for one in content.get("contradictory_isotherms", [])]
    if broken:
        parts.append(f"at {joined([f'{t:g}' for t in broken])} degC modulus and phase contradict each other")
    return " ".join(f"{part[:1].upper()}{part[1:]}." for part in parts)


def _flagged(content: Content) -> list[str]:
    """Quality limits that half of the tests exceed or more."""
    tests = content["tests"] + len(not_used(content))
    columns = [one["column"] for one in content.get("reading", {}).get("limits_exceeded", [])]
    return [
        f"{columns.count(name)} of {tests} exceed the limit of {limit.label} ({limit.limit:g} {limit.unit})"
        for name, limit in quality.LIMITS.items()
        if 2 * columns.count(name) >= tests
    ]


def _odd(content: Content) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    return content.get("odd_levels", []), content.get("odd_phases", [])


def _holding(content: Content) -> str:
    """What a scatter holds that is none: it is larger by that, and hides as much."""
    odd = levels.places(*_odd(content))
    return (
        f", but this scatter holds {joined(odd)}, which {'is' if len(odd) == 1 else 'are'} odd" if odd else ""
    )


def _spread(between: Mapping[str, float]) -> str:
    return f"Specimens differ by {between['E_percent']:.1f} % in |E*| and {between['phase_deg']:.1f} deg in phase"


def _fault(rung: Content) -> str:
    """Who carries a fault; perhaps, where the cause itself says why it is not certain."""
    where = rung["where"]
    one = isinstance(where, str)
    who = specimen_named(where) if one else ("all of them" if where is None else f"those at {where:g} degC")
    words = an(rung["cause"].replace("_", " "))
    if rung.get("established", True):
        return f"{who} {'carries' if one else 'carry'} {words} of {size(rung)}"
    return f"perhaps {who} {'carries' if one else 'carry'} {words} of {size(rung)} (not certain; the reason is below)"


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
        odd = _holding(content)
        return f"{SIMPLER} fits these data to within their scatter{odd or '; nothing is to be explained'}."
    first, last = (mean_averages(rung["gain"]["in_sample"]) for rung in (ladder[0], ladder[-1]))
    names = ("mre_E_percent", "mre_phase_percent")
    missed = [last[name]["after"] for name in names] if left is None else [left["E"], left["phase"]]
    before, after = (
        [f"{three_digits(error)} %" for error in errors]
        for errors in ([first[name]["before"] for name in names], missed)
    )
    facets = ["facets for bonds" for rung in ladder if rung["cause"] == BOND_MAPPING]
    found = joined([*facets, *(an(cause_words(rung)) for rung in ladder if rung["cause"] != BOND_MAPPING)])
    simpler = "the simulation of the paper" if facets else _first_law(content)
    worse = _worse([first[name]["before"] for name in names], missed)
    missed_by = "the mean of the specimens" if content["scatter"]["from_replicates"] else "the tests"
    return (
        f"{simpler} misses {missed_by} by {before[0]} of |E*| and {before[1]} of the phase; with {found} the "
        f"simulation misses by {after[0]} and {after[1]}, {_beyond_bonds(content)}.{worse}"
    )


def _first_law(content: Content) -> str:
    """The law that the first rung begins with: of too few tests no spectrum is told, but causes rest on one."""
    rung = content["ladder"][0]
    if rung["cause"] == "relaxation_spectrum":
        return SIMPLER
    first = mean_averages(rung["gain"]["in_sample"])["mre_E_percent"]["before"]
    burgers = list(content["baseline"]["mre_E_percent"].values())
    return SIMPLER if abs(first - sum(burgers) / len(burgers)) < 1e-3 * first else COMMON


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
            "Two frequencies cannot judge the simulation: a Burgers law fits them exactly, whatever is wrong. Test at "
            "three frequencies or more."
        )
    alone = len(content.get("reading", {}).get("specimens", [])) == 1
    lacking = "One specimen" if alone else "Specimens without a common temperature and frequency"
    add = "Test a second one at the same conditions" if alone else "Test two at the same conditions"
    return (
        f"{lacking} cannot judge the simulation: nothing was found, but the scatter from test to test is not known. "
        f"{add}, or state the scatter."
    )


def _beyond_bonds(content: Content) -> str:
    """Whether more than scatter is left, once what the simulated bonds add to their law is taken off."""
    doubtful = any(rung.get("doubts") for rung in content["ladder"])
    unsure = doubtful and content["verdict"] != "explained" and not _more_than_scatter(content)
    end = "no more" if unsure or content["verdict"] == "explained" else "more"
    by = ", but not every cause is certain" if unsure else ""
    by += _holding(content) if end == "no more" else ""
    bonds = content["numerics"]["largest_modulus_percent"]
    if bonds <= content["scatter"]["modulus_percent"]:
        return f"{end} than scatter can explain{by}"
    added = f"of which the simulated bonds add up to {bonds:.1f} % to |E*|"
    return f"{added}; the rest is {end} than scatter can explain{by}"


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


def not_used(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis left out."""
    return [one for one in content.get("suspect_tests", []) if not one["used"]]


def doubtful(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis used all the same."""
    return [one for one in content.get("suspect_tests", []) if one["used"]]


def with_suspects(content: Content) -> str:
    """What the suspect tests would have changed, had they been used; empty where no test is left out."""
    return _changed(content, "with_suspects", "If these tests were kept")


def on_doubtful(content: Content) -> str:
    """Which doubtful tests are used, and what is named without them; empty where there are none."""
    kept = doubtful(content)
    if not kept:
        return ""
    places = "; ".join(f"{place_of_test(one)} ({'; '.join(one['reasons'])})" for one in kept[:3])
    more = f"; and {len(kept) - 3} more, see suspect_tests in diagnosis.json" if kept[3:] else ""
    changed = _changed(
        content, "without_doubtful", f"If {'it were' if len(kept) == 1 else 'they were'} left out"
    )
    return f"Doubtful but used: {places}{more}. {changed}".rstrip()


def _changed(content: Content, key: str, when: str) -> str:
    """What another choice of tests would name; empty where there was none."""
    then = content.get(key)
    if then is None:
        return ""
    now = [cause_words(rung) for rung in content["ladder"] if rung["cause"] != BOND_MAPPING]
    other = [cause_words(rung) for rung in then["causes"]]
    more = joined([an(words) for words in other if words not in now])
    less = joined([an(words) for words in now if words not in other])
    changes = [f"also name {more}"] if more else []
    changes += [f"no longer name {less}"] if less else []
    return f"{when}, the diagnosis would {joined(changes) or 'name the same causes'}."


def place_of_test(one: Content) -> str:
    return f"{one['specimen']}, {one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz"


def causes(content: Content) -> list[tuple[str, str]]:
    """Each named cause with its size, then what its sign means and how sure the name is."""
    return [
        (
            _headed(rung) + _if_bending(rung, content),
            f"{_meaning(rung)}{_sure(rung, content)}",
        )
        for rung in content["ladder"]
    ]


def _headed(rung: Content) -> str:
    """A cause with its size; the law of the mix, which is none of the tests, is said to be so."""
    if rung["cause"] == "relaxation_spectrum":
        said = f"{cause_words(rung)} (a property of the mix, no fault): {size(rung)}"
        return said.removesuffix(": ")
    return f"{cause_words(rung)}: {size(rung)}".removesuffix(": ")


def _if_bending(rung: Content, content: Content) -> str:
    """The condition of a fault that a cylinder cannot have, where nobody said what was tested."""
    assumed = content.get("reading", {}).get("bench_assumed") and rung["cause"] in OF_THE_BENCH
    return ", if this was two-point bending" if assumed else ""


def _meaning(rung: Content) -> str:
    """What the sign of the amplitude says; empty for a cause that has but one."""
    if rung["cause"] not in SIGNS:
        return ""
    above, below = SIGNS[rung["cause"]]
    return f"{above if next(iter(rung['parameters'].values()))['value'] > 0.0 else below} "


def _sure(rung: Content, content: Content) -> str:
    if rung["cause"] == BOND_MAPPING:
        return f"Established: {rung['evidence']}."
    chance = (
        "by chance this happens in fewer than one of a million tables"
        if rung["p_value"] < 1e-6
        else (f"by chance this happens in {_per_cent(rung['p_value'])} of all tables")
    )
    if rung["as_good"]:
        others = joined([in_words(name) for name in rung["as_good"]], "or")
        return f"Not certain: {others} fits as well; these tests do not say which."
    if rung.get("hangs_on"):
        rests = joined(rung["hangs_on"])
        fails = "leave out any one" if len(rung["hangs_on"]) > 1 else "leave it out"
        return f"Not certain: it rests on {rests}: {fails} and it is no longer found."
    if rung.get("doubts"):
        first, *more = rung["doubts"]
        return f"Not certain: {'. '.join([first[:1].lower() + first[1:], *more])}."
    if not rung.get("established", True):
        return "Not certain: these tests are too few to exclude a cause outside the catalogue."
    if rung["cause"] != "relaxation_spectrum" and content.get("discrepancy"):
        return "Established. It stays whichever isotherm, frequency or specimen is left out."
    return f"Established: {chance}."


def in_words(name: str) -> str:
    """`temperature_bias @ 21.0` in words."""
    words, _, place = name.replace("_", " ").partition(" @ ")
    if not place:
        return words
    try:
        return f"{words} at {float(place):g} degC"
    except ValueError:
        return f"{words} at {place}"


def _more_than_scatter(content: Content) -> bool:
    """Whether the named causes leave structure, whatever the verdict says of their names."""
    pattern = content["largest_pattern_left"]
    chances = [content.get("lack_of_fit_p_value", 0.0), 1.0 if pattern is None else pattern["p_value"]]
    return min(chances) <= 0.5 * CHANCE


def left(content: Content) -> list[str]:
    """What no cause explains, largest first, in percent of |E*| or degrees of phase."""
    scatter, found = content["scatter"], content.get("discrepancy", {})
    parts = sorted(found.items(), key=lambda item: -item[1])[:LARGEST]
    if parts:
        odd = levels.places(*_odd(content))
        return [
            *(_part_left(name, value, scatter) for name, value in parts),
            *([f"{joined(odd)} took part in these sizes, although odd"] if odd else []),
        ]
    pattern = content["largest_pattern_left"]
    if content["verdict"] == "unexplained_structure" and pattern is not None and _more_than_scatter(content):
        if pattern["pattern"].count("slope over temperature") and _one_isotherm(content):
            return _largest(content)
        return [f"{pattern['pattern']}: {three_digits(pattern['z'])} times its standard error"]
    return []


def _one_isotherm(content: Content) -> bool:
    return len(content.get("reading", {}).get("isotherms_C", [])) == 1


def _largest(content: Content) -> list[str]:
    """The mean residual that is left over most, where a slope over temperature has no meaning."""
    found = [one for one in content.get("unexplained", []) if "specimen" not in one][:1]
    return [
        f"{abs(one['residual_E_percent']):.1f} % in |E*| and {abs(one['residual_phase_deg']):.1f} deg in the phase at "
        f"{one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz"
        for one in found
    ]


def _part_left(name: str, value: float, scatter: Content) -> str:
    """`specimen A, spectrum` or `37 degC, phase`, its size first."""
    place, part = name.removeprefix("specimen ").rsplit(", ", 1)
    if name.startswith("specimen "):
        place = f"of {specimen_named(place)}"
    else:
        place = f"{'at' if place.endswith(' degC') else 'of'} {place}"
    size = f"{size_left(name, value, scatter)} {place}"
    return f"{size}, which does not follow the common master curve" if part == "spectrum" else size


def size_left(name: str, value: float, scatter: Mapping[str, float]) -> str:
    """Size of a part of the discrepancy, whose value is in units of the scatter."""
    if name.endswith(", phase"):
        return f"{_one_digit(value * scatter['phase_deg'])} deg in the phase"
    return f"{_one_digit(value * scatter['modulus_percent'])} % in |E*|"


def _one_digit(value: float) -> str:
    return f"{value:.1f}" if value >= 0.1 else f"{value:.1g}"


def size(rung: Content) -> str:
    """Amplitude of a cause with its 95 % interval; empty where these tests do not give one."""
    name, amplitude = next(iter(rung["parameters"].items()))
    if name == "reference_temperature":
        return ""
    (value, unit), error = shown(amplitude["value"], amplitude["unit"]), amplitude["std_error"]
    unit = {"\N{DEGREE SIGN}": "deg", "\N{DEGREE SIGN}C": "degC"}.get(unit, unit)
    if error is None:
        interval = ""
    elif amplitude["value"] in BOUNDS.get(rung["cause"], ()):
        beyond = "more" if amplitude["value"] > 0.0 else "less"
        return f"{three_digits(value)} {unit} or {beyond} (the search ends there)"
    else:
        half = CONFIDENCE * shown(error, amplitude["unit"])[0]
        interval = f" +- {three_digits(float(f'{half:.2g}'))}"
    label = (
        f"{name.replace('_', ' ').replace('wlf ', 'WLF ')} " if rung["cause"] == "relaxation_spectrum" else ""
    )
    return f"{label}{three_digits(value)}{interval} {unit}".rstrip()


def cause_words(rung: Content) -> str:
    """`temperature bias at 30 degC`, `loose clamp of specimen 2`."""
    words, where = rung["cause"].replace("_", " "), rung["where"]
    if where is None:
        return words
    return f"{words} of {specimen_named(where)}" if isinstance(where, str) else f"{words} at {where:g} degC"


def an(words: str) -> str:
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def joined(words: Sequence[str], last: str = "and") -> str:
    """ "a, b and c"."""
    return f" {last} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def _per_cent(chance: float) -> str:
    return f"{three_digits(float(f'{100.0 * chance:.1g}'))} %"
