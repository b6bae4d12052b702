"""How the measurements were read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.measurements.campaign import isotherm_notes

LISTED = 4  # gaps of a table that are named


def reading(
    observed: Observations,
    off_target: Sequence[Mapping[str, Any]],
    notes: Sequence[str],
    without_tests: Sequence[str] = (),
) -> dict[str, Any]:
    """How the measurements were read: test type, isotherms, quality limits exceeded; notes of the import."""
    specimen = [observed.names[place] for place in observed.specimen]
    above = [
        {
            "specimen": specimen[one.row],
            "temperature_C": float(observed.isotherm[one.row]),
            "frequency_Hz": float(observed.frequency[one.row]),
            "column": one.column,
            "value": one.value,
            "limit": one.limit,
        }
        for one in quality.exceeded(observed)
    ]
    together = isotherm_notes(observed.temperature, observed.isotherm)
    if together:
        together.append("Both laws are fitted to the measured temperatures.")
    return {
        "test_type": observed.test_type,
        "specimens": list(observed.names),
        "isotherms_C": observed.isotherms.tolist(),
        "frequencies_Hz": observed.frequencies.tolist(),
        "quality_columns": [name for name in quality.COLUMNS if name in observed.quality],
        "limits_exceeded": above,
        "notes": [*notes, *together, *_quality_notes(above, observed)],
        "off_target": list(off_target),
        "not_tested": _gaps(observed),
        "files_without_tests": list(without_tests),
    }


def _gaps(observed: Observations) -> list[str]:
    """Specimens that were not tested at a temperature at which most others were, in words."""
    tested = {(int(k), float(t)) for k, t in zip(observed.specimen, observed.isotherm, strict=True)}
    missing = [
        f"{specimen_named(name)} at {t:g} degC"
        for k, name in enumerate(observed.names)
        for t in map(float, observed.isotherms)
        if (k, t) not in tested and 2 * sum(at == t for _, at in tested) > len(observed.names)
    ]
    more = [f"{len(missing) - LISTED} more"] if len(missing) > LISTED else []
    return [*missing[:LISTED], *more]


def _quality_notes(above: Sequence[Mapping[str, Any]], observed: Observations) -> list[str]:
    """A sentence for each quality limit that some tests exceed, with the worst of them; what follows if it is usual."""
    notes = []
    for name, limit in quality.LIMITS.items():
        found = sorted((one for one in above if one["column"] == name), key=lambda one: -one["value"])
        if found:
            worst = "; ".join(
                f"{one['specimen']} at {one['temperature_C']:g} degC, {one['frequency_Hz']:g} Hz: "
                f"{one['value']:g} {limit.unit}"
                for one in found[:3]
            )
            where = quality.where(observed, name)
            usual = (
                f" Half of the tests or more exceed it in {where}: check gauges and mounting. No single test is "
                "rejected for that."
            )
            notes.append(
                f"{limit.label.capitalize()} above {limit.limit:g} {limit.unit} ({quality.STANDARD}) in "
                f"{len(found)} of {observed.size} tests: {worst}{'; and others' * (len(found) > 3)}."
                f"{usual * bool(where)}"
            )
    return notes
