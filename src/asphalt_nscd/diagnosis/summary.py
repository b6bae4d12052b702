"""A diagnosis on the terminal: what can be trusted, what was found, how sure it is, what to do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tabulate import tabulate

from asphalt_nscd.diagnosis.written import CONFIDENCE, UNJUDGED, mean_averages, shown, three_digits

Content = Mapping[str, Any]
VERDICTS = {
    "explained": "Verdict: explained. What is left is the scatter of replicates.",
    "unexplained_structure": "Verdict: unexplained structure. More than scatter is left beside the causes named.",
    "nothing_to_explain": "Verdict: nothing to explain. The Burgers laws miss the data by no more than scatter.",
}
HELD_OUT = {
    "isotherms held out / scatter": "leave_one_isotherm_out",
    "frequencies held out / scatter": "leave_one_frequency_out",
}
HEADERS = ["cause", "where", "parameter, 95 %", "p", "error |E*| %", "error phase %", *HELD_OUT]
LARGEST = 4  # parts of the discrepancy that are listed


def summary(content: Content) -> str:
    """The ladder as a table, with the tests not used, the verdict and the notes."""
    scatter, read = content["scatter"], content.get("reading", {"notes": []})
    judged = content["verdict"] != "nothing_to_explain" or content["tested"]
    rows = [_row(rung) for rung in content["ladder"]]
    lines = [
        *read["notes"],
        *([""] if read["notes"] else []),
        f"{content['tests']} tests used. One test scatters by {scatter['modulus_percent']:.3g} % in |E*| and "
        f"{scatter['phase_deg']:.3g} deg in phase; specimens differ by {scatter['specimens_percent']:.2g} % in |E*|.",
        *_suspects(content),
        "",
        tabulate(rows, HEADERS) if rows else "No cause beats chance.",
        "",
        *_how_sure(content),
        VERDICTS[content["verdict"]] if judged else f"Verdict: {UNJUDGED}.",
        *_left(content),
    ]
    return "\n".join([*lines, *content["notes"]])


def _row(rung: Content) -> list[str]:
    inside = mean_averages(rung["gain"]["in_sample"])
    held = rung["gain"]["held_out"]
    return [
        rung["cause"], "" if rung["where"] is None else rung["where"], _size(rung["parameters"]),
        "" if rung["p_value"] is None else f"{rung['p_value']:.1g}" if rung["p_value"] > 1e-6 else "< 1e-6",
        *("{before:.2f} -> {after:.2f}".format(**pair) for pair in inside.values()),
        *(
            "{before:.2f} -> {after:.2f}".format(**held[way]["rms_over_scatter"]) if way in held else ""
            for way in HELD_OUT.values()
        ),
    ]  # fmt: skip


def _size(parameters: Content) -> str:
    """The first parameter, which is the amplitude, with its 95 % interval."""
    name, amplitude = next(iter(parameters.items()))
    if name == "reference_temperature":  # of a law whose shift these tests do not determine
        return ""
    (value, unit), error = shown(amplitude["value"], amplitude["unit"]), amplitude["std_error"]
    interval = "" if error is None else f" +- {CONFIDENCE * shown(error, amplitude['unit'])[0]:.2g}"
    return f"{name} {value:.3g}{interval} {unit}".rstrip()


def _suspects(content: Content) -> list[str]:
    """How many tests are doubtful; the notes say which are not used, and why."""
    found = content.get("suspect_tests", [])
    kept = sum(one["used"] for one in found)
    lines = [f"Tests not used: {len(found) - kept}; the reasons stand below."] if kept < len(found) else []
    if kept:
        lines.append(f"Doubtful but used: {kept}; suspect_tests in diagnosis.json says why.")
    return lines


def _how_sure(content: Content) -> list[str]:
    """A sentence for each cause: established, or what it hangs on."""
    lines = []
    for rung in content["ladder"]:
        where = "" if rung["where"] is None else f" ({rung['where']})"
        if rung.get("evidence"):
            lines.append(f"{rung['cause']}: {rung['evidence']}.")
        elif rung["as_good"]:
            lines.append(
                f"{rung['cause']}{where}: likely. {', '.join(rung['as_good'])} fits as well; the data do not say which."
            )
        elif rung.get("hangs_on"):
            lines.append(
                f"{rung['cause']}{where}: likely, not established. Without {', '.join(rung['hangs_on'])} these data do "
                "not show it."
            )
        elif (
            rung["cause"] != "relaxation_spectrum" and content.get("discrepancy") and rung.get("established")
        ):
            lines.append(
                f"{rung['cause']}{where}: established. It stays whichever isotherm, frequency or specimen is left out."
            )
    return lines


def _left(content: Content) -> list[str]:
    """What is left without a name, and where."""
    left, lines = content["largest_pattern_left"], []
    sizes = sorted(content.get("discrepancy", {}).items(), key=lambda item: -item[1])[:LARGEST]
    if sizes:
        parts = ", ".join(f"{name} {three_digits(size)}" for name, size in sizes)
        lines.append(f"Left without a name, in units of the scatter of one test: {parts}.")
    elif content["verdict"] == "unexplained_structure" and left is not None:
        lines.append(
            f"Largest pattern left: {left['pattern']}, {left['z']:.1f} standard deviations of one pattern, "
            f"p = {left['p_value']:.2g} among all."
        )
    if content["withdrawn"]:
        lines.append(
            f"Considered and dropped, because a discrepancy fits as well: {', '.join(content['withdrawn'])}."
        )
    return lines
