"""What the law or the simulation misses, where a law must not be used, and how to correct a fault."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.diagnosis.words.sentences import (
    LAW,
    Content,
    article,
    cause_words,
    named,
    odd,
    unused_tests,
)
from asphalt_nscd.diagnosis.written import mean_averages, three_digits
from asphalt_nscd.files.words import joined
from asphalt_nscd.measurements.kinds import TEST_TYPES, UNKNOWN

TESTS_OF = TEST_TYPES | {UNKNOWN: "tests of a kind that was not said"}
EFFECTS = {cause.name for cause in CATALOGUE if cause.stage == MATERIAL and not cause.confined_to}
ALTERING = {cause.name for cause in CATALOGUE if cause.alters_tests}
OF_THE_MIX = EFFECTS | {LAW, BOND_MAPPING}
SIMPLER = "one Burgers law for each temperature"
COMMON = "the free master curve"  # the name of the law of the diagnosis; the other is called law.json
TWO_LAWS = (
    f"Two laws are fitted. The diagnosis uses {COMMON}, a master curve of any smooth shape. law.json holds a law of "
    "few parameters (2S2P1D unless --law says another) for use in other programs."
)
TWO_FREQUENCIES = (
    "Two frequencies cannot judge a law: a Burgers law fits them exactly, whatever is wrong. Test at three frequencies "
    "or more."
)
WORSE, AT_ALL = 1.1, 0.5  # times an error of before, and percent more, at which a law has made it worse


def mixes(content: Content) -> str:
    """That specimens are hardly of one mix: |E*| scatters between them by more than ONE_MIX percent; else empty."""
    spread = (content["repeatability"] or {}).get("between")
    if spread is None or spread["E_percent"] <= levels.ONE_MIX:
        return ""
    return (
        f"Specimens scatter by {spread['E_percent']:.1f} % in |E*| and {spread['phase_deg']:.1f} deg in phase, more "
        "than those of one mix do. If there are two mixes, diagnose each alone."
    )


def faults(content: Content) -> list[Content]:
    """Named faults of the tests, in the order in which the ladder took them."""
    return [rung for rung in content["ladder"] if rung["cause"] not in OF_THE_MIX]


def effects(content: Content) -> list[Content]:
    """Named effects of the mix itself beside its relaxation: what it does while it is tested, in the ladder's order."""
    return [rung for rung in content["ladder"] if rung["cause"] in EFFECTS]


def rivalled_by_a_fault(content: Content) -> bool:
    """Whether a fault of the tests fits as well as an effect that is named."""
    rivals = (name for rung in effects(content) for name in rung["as_good"])
    return any(name.partition(" @ ")[0] not in OF_THE_MIX for name in rivals)


def taken_off(rung: Content) -> bool:
    """Whether corrected.csv is free of a cause once it is established: what a mix does itself stays in it."""
    return rung["cause"] in ALTERING


def correction(rung: Content) -> str:
    """What to do to the tests to be rid of a fault, where it is one number; empty where no one number corrects it."""
    value = next(iter(rung["parameters"].values()))["value"]
    cause = next((one for one in CATALOGUE if one.name == rung["cause"]), None)
    return "" if cause is None else cause.correction(value, rung["where"])


def simulation_miss(content: Content, left: Mapping[str, float] | None = None) -> str:
    """One sentence: what the simulation misses with the paper's laws, and with what was found.

    Mean errors over the temperatures, or why nothing is judged. `left`: errors [%] of "E" and "phase" that tests
    simulated with it have left; else those of the diagnosis.
    """
    ladder = content["ladder"]
    if not ladder:
        if content["verdict"] != "nothing_to_explain":
            return f"{SIMPLER} leaves more than scatter, and no cause of the catalogue explains it."
        if not content["tested"]:
            return _cannot_judge(content)
        holds = _holding(content)
        return f"{SIMPLER} fits these tests to within their scatter{holds or '; nothing is left to explain'}."
    first, last = (mean_averages(rung["gain"]["in_sample"]) for rung in (ladder[0], ladder[-1]))
    had = [errors["before"] for errors in first.values()]
    missed = [errors["after"] for errors in last.values()] if left is None else [left["E"], left["phase"]]
    written = three_digits if left is not None or bonded(content) else _two
    before, after = ([f"{written(error)} %" for error in errors] for errors in (had, missed))
    worse = _worse(had, missed)
    facets = ["facets for bonds"] if bonded(content) else []
    found = joined([*facets, *(_noun(rung) for rung in ladder if rung["cause"] != BOND_MAPPING)])
    simpler = "this simulation with the bonds of the paper" if facets else _first_law(content)
    missed_by = held_against(content)
    if facets or left is not None:
        return (
            f"{simpler} misses {missed_by} by {before[0]} of |E*| and {before[1]} of the phase; with {found} the "
            f"simulation misses by {after[0]} and {after[1]}, {_misfit_beyond_bonds(content)}.{worse}"
        )
    law = COMMON if named(content, LAW) else simpler
    found = joined([_noun(rung) for rung in ladder if rung["cause"] != LAW])
    these = "this cause" if len(ladder) == 1 else "these causes"
    without = f" Without {these} it misses by {before[0]} and {before[1]}."
    return (
        f"{law}{f', fitted together with {found},' * bool(found)} misses {missed_by} by {after[0]} in |E*| and "
        f"{after[1]} in the phase, {_misfit_beyond_bonds(content)}.{without * (law == simpler)}{worse}"
    )


def two_laws(content: Content) -> list[str]:
    """What the free master curve and law.json are, and why their errors differ; empty unless both are fitted."""
    misses = content["law_misses"]
    if misses is None or not named(content, LAW) or bonded(content):
        return []
    open_to_doubt = [rung for rung in [*faults(content), *effects(content)] if not rung["established"]]
    unsure = [_noun(rung) for rung in open_to_doubt]
    are, them = ("is", "it") if len(unsure) == 1 else ("are", "them")
    rivals = ", with what fits as well" * any(sentences.rivals(rung, content) for rung in open_to_doubt)
    weighed = (
        f"{are} not certain: law.json is the mean with {them}{rivals} and without, by their probability."
    )
    doubtful = f" {joined(unsure).capitalize()} {weighed}" * bool(unsure)
    out = held_back(content)
    fewer = f", those of law.json without {joined(out)}" if out else ""
    neither = " Tests left out are in neither." * bool(unused_tests(content))
    return [
        f"law.json misses {held_against(content)} by {misses['mre_E_percent']:.2g} % in |E*| and "
        f"{misses['mre_phase_percent']:.2g} % in the phase.{doubtful}",
        "The two weigh the tests differently. For law.json all tests count alike, |E*| as much as the phase. For "
        f"{COMMON} a test counts less the more it scatters, and a temperature or a specimen that no master curve fits "
        f"counts little. All these misfits are means over the temperatures{fewer}.{neither}",
    ]


def held_back(content: Content) -> list[str]:
    """What law.json and reported.csv are made without until a check clears it, in words; empty where nothing is."""
    if not content["trust"]["held_back"]:
        return []
    highest = content["highest_frequency"]
    at = [] if highest is None else [f"the tests at {highest['frequency_Hz']:g} Hz"]
    return [*levels.places(*odd(content)), *at]


def held_against(content: Content) -> str:
    """What a law is held against: the mean of the specimens, or the tests themselves where nothing was repeated."""
    return "the mean of the specimens" if content["scatter"]["from_replicates"] else "the tests"


def _noun(rung: Content) -> str:
    """A named cause as a thing that tests show."""
    words = cause_words(rung)
    return article(words.replace("specimen geometry", "error of the dimensions") if rung["where"] else words)


def bonded(content: Content) -> bool:
    """Whether the ladder has a rung of the bond mapping: simulations took part, and their bonds come first."""
    return named(content, BOND_MAPPING)


def _first_law(content: Content) -> str:
    """The law that the first rung begins with: of too few tests no spectrum is told, but causes rest on one."""
    rung = content["ladder"][0]
    if rung["cause"] == LAW:
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
    if not sentences.alone(content):
        return TWO_FREQUENCIES
    single = len(content["reading"]["specimens"]) == 1
    lacking = "One specimen" if single else "Specimens without a common temperature and frequency"
    return (
        f"{lacking} cannot judge a law: nothing was found, but the scatter from test to test is not known. Test "
        f"{'a second one' if single else 'two'} at the same conditions, or state the scatter."
    )


def _misfit_beyond_bonds(content: Content) -> str:
    """Whether more than scatter is left, once what the simulated bonds add to their law is taken off."""
    if not content["tested"] and sentences.alone(content):
        return "and nobody knows how much of that is scatter"
    fits = content["verdict"] == "explained" or not sentences.exceeds_scatter(content)
    causes = [rung for rung in content["ladder"] if rung["cause"] not in (LAW, BOND_MAPPING)]
    sure = all(rung["established"] for rung in causes)
    within = " within specimens" if content["scatter"]["from_replicates"] else ""
    scatter = "no more than scatter can explain" if fits else f"more than scatter{within} can explain"
    by = "" if sure or not fits else ", but not every cause is certain"
    by += _holding(content) if fits else "" if causes else ", and no cause was found"
    bonds = content["numerics"]["largest_modulus_percent"]
    added = f"of which the simulated bonds add up to {bonds:.1f} % to |E*|; the rest is "
    return f"{added * (bonds > content['scatter']['modulus_percent'])}{scatter}{by}"


def _two(error: float) -> str:
    return f"{float(f'{error:.2g}'):g}"


def files(content: Content) -> str:
    """A sentence for each file of a folder that gave no test; empty where all did."""
    return " ".join(content["reading"]["files_without_tests"])
