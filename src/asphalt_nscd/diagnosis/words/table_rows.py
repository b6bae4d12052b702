"""Tables of a diagnosis as rows of text, for the terminal and for the page alike."""

from __future__ import annotations

from asphalt_nscd.diagnosis.words.sentences import Content
from asphalt_nscd.diagnosis.written import shown, three_digits


def scatter_rows(content: Content) -> list[list[str]]:
    """Scatter between and within specimens [% of |E*|, degrees] by isotherm, then of all; empty without replicates."""
    found = content["repeatability"]
    if found is None:
        return []
    rows = [("all", found), *((f"{one['temperature_C']:g} degC", one) for one in found["by_isotherm"])]
    return [[name, *_four(row)] for name, row in rows[1:] + rows[:1]]


def excess_rows(content: Content) -> list[list[str]]:
    """Excess of the phase [degrees] by isotherm, its standard error, and the machine's drift of deformation [%]."""
    rows = []
    for one in content["excess_phase"]:
        drift = one["deformation_drift_percent"]
        excess, error = (f"{one[key]:.2f}" for key in ("excess_deg", "standard_error_deg"))
        rows.append(
            [f"{one['temperature_C']:g} degC", excess, error, "" if drift is None else f"{drift:.0f}"]
        )
    return rows


def measured_limits(content: Content) -> list[list[str]]:
    """Cause, its limit, how often it was named of how many tries at 1, 2, 3 times it; how often another was named."""
    rows = []
    for cause, by_times in content["measured_limits"].items():
        limit = content["detection_limits"][cause]
        value, unit = shown(limit["value"], limit["unit"])
        stated = [cause.replace("_", " "), f"{three_digits(value)} {unit}".rstrip()]
        tried = [by_times.get(times) for times in ("1", "2", "3")]
        found = ["" if one is None else f"{one['named']} of {one['tried']}" for one in tried]
        rows.append([*stated, *found, str(sum(one["other_named"] for one in by_times.values()))])
    return rows


LIMITS_STATED = (
    "Each cause was put into these tests, and the table diagnosed again. Stated: named in 95 % of cases at the limit, "
    "in all at twice the limit."
)
LIMITS_HEAD = ["cause", "stated limit", "named at the limit", "at twice", "at three times", "other names"]
SCATTER_CAPTION = (
    "Standard deviations at one temperature and frequency. Between: among the specimens. Within: of one specimen about "
    "its own level at that temperature."
)
EXCESS_CAPTION = (
    "How far the phase lies above what |E*| of the same isotherm requires, mean over its frequencies. "
    "A linear mix that is measured without fault has no excess. It needs no law of the mix."
)
EXCESS_HEAD = ["isotherm", "excess, deg", "standard error, deg", "machine's drift of deformation, %"]
SCATTER_HEAD = ["isotherm", "between, |E*| %", "between, phase deg", "within, |E*| %", "within, phase deg"]


def _four(row: Content) -> list[str]:
    return [
        "" if row[way] is None else f"{row[way][name]:.{digits}f}"
        for way in ("between", "within")
        for name, digits in (("E_percent", 1), ("phase_deg", 2))
    ]
