"""Tables of a diagnosis as rows of text, for the terminal and for the page alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from asphalt_nscd.diagnosis.words.sentences import estimate

Content = Mapping[str, Any]
DRIFT = (
    " The drift is the machine's own: how far the mean deformation moved during the test, in percent of its amplitude. "
    "In a mix that creeps under its load it may well exceed 100 %; the sign is the machine's."
)


class Table(NamedTuple):
    """A titled table of text."""

    title: str
    caption: str
    head: list[str]
    rows: list[list[str]]


def tables(content: Content) -> list[Table]:
    """Scatter, excess phase, and limits stated and measured, where there are any."""
    found = [
        Table(
            "Scatter",
            "Standard deviations at one temperature and frequency. Between: among the specimens. Within: of one "
            "specimen about its own level at that temperature.",
            ["isotherm", "between, |E*| %", "between, phase deg", "within, |E*| %", "within, phase deg"],
            _scatter(content),
        ),
        Table(
            "Phase above what |E*| requires",
            "How far the phase lies above what |E*| of the same isotherm requires, mean over its frequencies. A linear "
            "mix that is measured without fault has no excess. It needs no law of the mix."
            + DRIFT
            * any(one["deformation_drift_percent"] is not None for one in content["excess_phase"]),
            ["isotherm", "excess, deg", "standard error, deg", "machine's drift of deformation, %"],
            [
                [
                    f"{one['temperature_C']:g} degC",
                    *_numbers(
                        one, {"excess_deg": 2, "standard_error_deg": 2, "deformation_drift_percent": 0}
                    ),
                ]
                for one in content["excess_phase"]
            ],
        ),
        Table(
            "Limits, stated and measured",
            "Each cause was put into these tests, and the table diagnosed again. Stated: named in 95 % of cases at the "
            "limit, in all at twice the limit.",
            ["cause", "stated limit", "named at the limit", "at twice", "at three times", "other names"],
            [_tried(content, cause) for cause in content["measured_limits"]],
        ),
    ]
    return [_filled(table) for table in found if table.rows]


def _filled(table: Table) -> Table:
    """The table without columns that are empty."""
    kept = [k for k in range(len(table.head)) if any(row[k] for row in table.rows)]
    return table._replace(
        head=[table.head[k] for k in kept], rows=[[row[k] for k in kept] for row in table.rows]
    )


def _numbers(of: Mapping[str, Any] | None, digits: Mapping[str, int]) -> list[str]:
    """Some numbers with so many digits behind the point; empty where there is none."""
    return ["" if of is None or of[key] is None else f"{of[key]:.{n}f}" for key, n in digits.items()]


def _scatter(content: Content) -> list[list[str]]:
    """Scatter between and within specimens by isotherm, then of all."""
    found = content["repeatability"]
    if found is None:
        return []
    rows = [(f"{one['temperature_C']:g} degC", one) for one in found["by_isotherm"]] + [("all", found)]
    digits = {"E_percent": 1, "phase_deg": 2}
    return [[name, *_numbers(row["between"], digits), *_numbers(row["within"], digits)] for name, row in rows]


def _tried(content: Content, cause: str) -> list[str]:
    """Cause, limit, how often it was named of how many tries at 1, 2, 3 times that, how often another was."""
    by_times = content["measured_limits"][cause]
    tried = [by_times.get(times) for times in ("1", "2", "3")]
    found = ["" if one is None else f"{one['named']} of {one['tried']}" for one in tried]
    others = sum(one["other_named"] for one in by_times.values())
    limit = estimate(content["detection_limits"][cause] | {"std_error": None})
    return [cause.replace("_", " "), limit, *found, str(others)]
