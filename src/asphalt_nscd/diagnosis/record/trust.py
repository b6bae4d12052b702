"""How the measurements were read, and how many of them can be used as they are."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.measurements.campaign import OFF_TARGET, isotherm_notes

LISTED = 4  # gaps of a table that are named


def reading(
    observed: Observations, notes: Sequence[str], without_tests: Sequence[str] = ()
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
        "quality_columns": [name for name in quality.COLUMNS if name in observed.quality],
        "limits_exceeded": above,
        "notes": [*notes, *together, *_quality_notes(above, observed)],
        **({"off_target": off} if (off := _off_target(observed)) else {}),
        **({"not_tested": gaps} if (gaps := _gaps(observed)) else {}),
        **({"files_without_tests": list(without_tests)} if without_tests else {}),
    }


def trust(
    observed: Observations, diagnosis: Diagnosis, odd: NDArray[np.bool_], broken: Collection[float]
) -> dict[str, Any]:
    """How many tests, also by specimen, can be used as they are, after a check (`odd`, `broken` [degC]) or not."""
    out = np.zeros(observed.size, bool)
    out[[one.row for one in diagnosis.suspects if not one.used]] = True
    check = odd | np.isin(observed.isotherm, list(broken))
    check |= levels.rows(observed, _off_target(observed))
    above = quality.exceeded(observed)
    for name in quality.LIMITS:
        rows = [one.row for one in above if one.column == name]
        if 2 * len(rows) >= observed.size:
            check[rows] = True
    check[[one.row for one in diagnosis.suspects if one.used]] = True
    check &= ~out
    use = ~check & ~out
    whole = [float(t) for t in observed.isotherms if (check | out)[observed.isotherm == t].all()]
    rest = use | out | np.isin(observed.isotherm, whole)
    alone = check.any() and rest.all() and len(whole) < observed.isotherms.size
    return {
        "use": int(use.sum()),
        "check": int(check.sum()),
        "not_used": int(out.sum()),
        **({"check_at_C": whole} if alone else {}),
        "use_by_specimen": {n: int(use[observed.specimen == k].sum()) for k, n in enumerate(observed.names)},
    }


def _off_target(observed: Observations) -> list[dict[str, Any]]:
    """Isotherms of a specimen measured further from their target than T 378 allows, and their mean temperature."""
    found = []
    for k, t in np.unique(np.column_stack([observed.specimen, observed.isotherm]), axis=0):
        measured = float(observed.temperature[(observed.specimen == k) & (observed.isotherm == t)].mean())
        # Readings have a tenth of a degree: 0.5 is not above 0.5 whatever the last bit says.
        if abs(measured - t) > OFF_TARGET + 1e-9:
            name = observed.names[int(k)]
            found.append({"specimen": name, "temperature_C": float(t), "measured_C": round(measured, 2)})
    return found


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
