"""What a diagnosis says in plain sentences, for the terminal and for the page alike.

Units are written as on a terminal (degC, deg, +-); the page sets them in type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from asphalt_nscd.diagnosis.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL
from asphalt_nscd.diagnosis.chance import CHANCE
from asphalt_nscd.diagnosis.written import CONFIDENCE, mean_averages, shown, three_digits

Content = Mapping[str, Any]
TEST_TYPES = {
    "bending": "two-point bending of a trapezoidal specimen",
    "tension-compression": "axial test of a cylinder (tension-compression, AMPT or UTM)",
}
OF_THE_MIX = {cause.name for cause in CATALOGUE if cause.stage == MATERIAL} | {
    "relaxation_spectrum",
    BOND_MAPPING,
}
SIMPLER = "one Burgers law for each temperature"
LARGEST = 4  # parts of what stays unexplained that are listed
CANNOT_JUDGE = "Nothing was found, but these data cannot judge the simulation"


def on_data(content: Content) -> str:
    """One sentence: how many tests can be used, which fault they carry, which isotherm contradicts itself."""
    out = len(not_used(content))
    tests = content["tests"]
    usable = f"{tests} of {tests + out} tests can be used" if out else f"all {tests} tests can be used"
    faults = [rung for rung in content["ladder"] if rung["cause"] not in OF_THE_MIX]
    parts = [usable, *(_fault(rung) for rung in faults)]
    broken = [one["temperature_C"] for one in content.get("contradictory_isotherms", [])]
    if broken:
        parts.append(f"at {joined([f'{t:g}' for t in broken])} degC modulus and phase contradict each other")
    return f"{'; '.join(parts)}."


def _fault(rung: Content) -> str:
    where = f"specimen {rung['where']}" if isinstance(rung["where"], str) else "they"
    carry = "carries" if isinstance(rung["where"], str) else "carry"
    carry = carry if rung.get("established") else f"probably {carry}"
    return f"{where} {carry} {an(cause_words(rung))} of {size(rung)}"


def on_simulation(content: Content) -> str:
    """One sentence: what the simulation misses with the paper's laws, and with what was found."""
    ladder = content["ladder"]
    if not ladder:
        if content["verdict"] != "nothing_to_explain":
            return f"{SIMPLER} leaves more than scatter, and no cause of the catalogue explains it."
        if not content["tested"]:
            return f"{CANNOT_JUDGE}."
        return f"{SIMPLER} fits these data to within their scatter; nothing is to be explained."
    first, last = (mean_averages(rung["gain"]["in_sample"]) for rung in (ladder[0], ladder[-1]))
    before, after = (
        f"{three_digits(gain['mre_E_percent'][when])} % in |E*| and {three_digits(gain['mre_phase_percent'][when])} % in "
        "phase"
        for gain, when in ((first, "before"), (last, "after"))
    )
    facets = [rung for rung in ladder if rung["cause"] == BOND_MAPPING]
    with_them = ["facets for bonds"] * len(facets) + [
        an(cause_words(rung)) for rung in ladder if rung not in facets
    ]
    as_it_was = "as in the paper" if facets else f"with {SIMPLER}"
    end = {
        "explained": "no more than the scatter of the tests",
        "unexplained_structure": "more than the scatter of the tests",
    }.get(content["verdict"], "")
    if any(rung.get("doubts") for rung in ladder) and not _more_than_scatter(content):
        end = "no more than the scatter of the tests, by a cause that is not established"
    return f"with {joined(with_them)} it misses the data by {after}, {end}; {as_it_was} by {before}."


def test_type(content: Content) -> str:
    """The test, its specimens and its isotherms."""
    read = content.get("reading")
    if read is None:
        return ""
    at = joined([f"{t:g}" for t in read["isotherms_C"]])
    return f"{TEST_TYPES[read['test_type']]}, {len(read['specimens'])} specimens, {at} degC"


def not_used(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis left out."""
    return [one for one in content.get("suspect_tests", []) if not one["used"]]


def doubtful(content: Content) -> list[Content]:
    """Suspect tests that the diagnosis used all the same."""
    return [one for one in content.get("suspect_tests", []) if one["used"]]


def place_of_test(one: Content) -> str:
    return f"{one['specimen']}, {one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz"


def causes(content: Content) -> list[tuple[str, str]]:
    """Each named cause with its size, and how sure the name is."""
    return [
        (f"{cause_words(rung)}: {size(rung)}".removesuffix(": "), _sure(rung, content))
        for rung in content["ladder"]
    ]


def _sure(rung: Content, content: Content) -> str:
    if rung["cause"] == BOND_MAPPING:
        return f"Established: {rung['evidence']}."
    chance = "chance alone does as well in less than 1 of a million tables" if rung["p_value"] < 1e-6 else (
        f"chance alone does as well in {_per_cent(rung['p_value'])} of all tables"
    )  # fmt: skip
    if rung["as_good"]:
        others = joined([name.replace("_", " ").replace(" @ ", " at ") for name in rung["as_good"]], "or")
        return f"Likely. {others[:1].upper()}{others[1:]} fits as well; these tests do not say which."
    if rung.get("hangs_on"):
        return (
            f"Likely, not established. Without {joined(rung['hangs_on'], 'or')} these tests do not show it."
        )
    if rung.get("doubts"):
        return f"Likely, not established. {'. '.join(rung['doubts'])}."
    if not rung.get("established", True):
        return "Likely, not established. These tests are too few to exclude what the catalogue lacks."
    if rung["cause"] != "relaxation_spectrum" and content.get("discrepancy"):
        return "Established. It stays whichever isotherm, frequency or specimen is left out."
    return f"Established: {chance}."


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
        return [f"{name}: {_in_units(name, value, scatter)}" for name, value in parts]
    pattern = content["largest_pattern_left"]
    if content["verdict"] == "unexplained_structure" and pattern is not None and _more_than_scatter(content):
        return [f"{pattern['pattern']}: {three_digits(pattern['z'])} standard deviations"]
    return []


def _in_units(name: str, value: float, scatter: Content) -> str:
    if name.endswith("phase"):
        return f"{three_digits(round(value * scatter['phase_deg'], 2))} deg"
    return f"{three_digits(round(value * scatter['modulus_percent'], 1))} % in |E*|"


def scatter_rows(content: Content) -> list[list[str]]:
    """Isotherm, then between and within specimens: percent of |E*| and degrees of phase."""
    found = content.get("repeatability")
    if found is None:
        return []
    rows = [("all", found), *((f"{one['temperature_C']:g} degC", one) for one in found["by_isotherm"])]
    return [[name, *_four(row)] for name, row in rows[1:] + rows[:1]]


SCATTER_HEAD = ["isotherm", "between, |E*| %", "between, phase deg", "within, |E*| %", "within, phase deg"]


def _four(row: Content) -> list[str]:
    return [
        "" if row[way] is None else f"{row[way][name]:.{digits}f}"
        for way in ("between", "within")
        for name, digits in (("E_percent", 1), ("phase_deg", 2))
    ]


def size(rung: Content) -> str:
    """Amplitude of a cause with its 95 % interval; empty where these tests do not give one."""
    name, amplitude = next(iter(rung["parameters"].items()))
    if name == "reference_temperature":
        return ""
    (value, unit), error = shown(amplitude["value"], amplitude["unit"]), amplitude["std_error"]
    unit = {"\N{DEGREE SIGN}": "deg", "\N{DEGREE SIGN}C": "degC"}.get(unit, unit)
    if error is None:
        interval = ""
    else:
        half = CONFIDENCE * shown(error, amplitude["unit"])[0]
        interval = f" +- {three_digits(float(f'{half:.2g}'))}"
    if rung["cause"] == BOND_MAPPING:
        return f"|E*| is {three_digits(value)} of the law"
    label = (
        f"{name.replace('_', ' ').replace('wlf ', 'WLF ')} " if rung["cause"] == "relaxation_spectrum" else ""
    )
    return f"{label}{three_digits(value)}{interval} {unit}".rstrip()


def cause_words(rung: Content) -> str:
    """`temperature bias at 30 degC`, `loose clamp of specimen 2`."""
    words, where = rung["cause"].replace("_", " "), rung["where"]
    if where is None:
        return words
    return f"{words} of specimen {where}" if isinstance(where, str) else f"{words} at {where:g} degC"


def an(words: str) -> str:
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def joined(words: Sequence[str], last: str = "and") -> str:
    """ "a, b and c"."""
    return f" {last} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def _per_cent(chance: float) -> str:
    return f"{three_digits(float(f'{100.0 * chance:.1g}'))} %"
