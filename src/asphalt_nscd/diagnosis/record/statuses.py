"""One record of each test: what became of it, why, and what decided that. All outputs tell of a test from it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.content.doubts import DOUBTFUL, HELD_BACK, ITSELF, LEFT_OUT, USED
from asphalt_nscd.diagnosis.observed import quality
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import levels, suspects
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.measurements.campaign import OFF_TARGET

Rows = NDArray[np.bool_]
Entries = list[dict[str, Any]]
STATUSES = (USED, DOUBTFUL, HELD_BACK, LEFT_OUT)


@dataclass(frozen=True)
class Places:
    """What is odd beyond single tests, as `diagnosis.json` holds it.

    `moduli`, `phases` and `temperatures`: isotherms and specimens; `contradictory`: isotherms [degC]; `off_target`:
    sweeps; `highest`: rows (n,) of all tests that an error of the highest frequency makes odd.
    """

    moduli: Entries
    phases: Entries
    temperatures: Entries
    contradictory: Entries
    off_target: Entries
    highest: Rows

    @property
    def words(self) -> list[str]:
        """Each odd isotherm or specimen once."""
        return levels.places(self.moduli, self.phases, self.temperatures)


def odd_places(diagnosis: Diagnosis, whole: Observations) -> Places:
    """Isotherms, sweeps and specimens that are odd, of a diagnosis of `whole`."""
    ladder = diagnosis.ladder
    own = ladder.confined_faults
    moduli, phases, temperatures = (
        [one for one in own if key in one] for key in ("factor", "phase_deg", "kelvin")
    )
    contradictory: Entries = []
    for one in suspects.broken_isotherms(whole, diagnosis.left_out, ladder.torn):
        worst = int(np.argmax(np.abs(one.difference)))
        contradictory.append(
            {
                "temperature_C": one.temperature,
                "sentence": one.sentence,
                "worst_Hz": float(one.frequency[worst]),
                "worst_deg": float(one.difference[worst]),
            }
        )
    told = [one["temperature_C"] for one in contradictory]
    contradictory += [one for one in own if "offset_deg" in one and one["temperature_C"] not in told]
    highest = np.zeros(whole.size, bool) if ladder.at_highest is None else ladder.at_highest.rows(whole)
    return Places(moduli, phases, temperatures, contradictory, off_target(whole), highest)


def off_target(observed: Observations) -> Entries:
    """Isotherms of a specimen measured further from their target than T 378 allows, and their mean temperature."""
    found = []
    for k, t in np.unique(np.column_stack([observed.specimen, observed.isotherm]), axis=0):
        measured = float(observed.temperature[(observed.specimen == k) & (observed.isotherm == t)].mean())
        # Readings have a tenth of a degree: 0.5 is not above 0.5 whatever the last bit says.
        if abs(measured - t) > OFF_TARGET + 1e-9:
            name = observed.names[int(k)]
            found.append({"specimen": name, "temperature_C": float(t), "measured_C": round(measured, 2)})
    return found


def statuses(diagnosis: Diagnosis, whole: Observations, odd: Places) -> pd.DataFrame:
    """Specimen, temperature_C and frequency_Hz of each test (n rows), with its status, why and decided_by."""
    status = np.full(whole.size, USED, object)
    why: list[list[str]] = [[] for _ in range(whole.size)]
    by: list[list[str]] = [[] for _ in range(whole.size)]
    for taken, rows, decided_by, reasons in _reasons(diagnosis, whole, odd):
        for row in np.flatnonzero(rows):
            status[row] = max(status[row], taken, key=STATUSES.index)
            why[row] += [one for one in reasons if one not in why[row]]
            by[row] += [decided_by] * (decided_by not in by[row])
    if np.unique(whole.isotherm[_is_in_law(status)]).size < diagnosis.observed.isotherms.size:
        status[status == HELD_BACK] = DOUBTFUL  # the rest makes no law
    return pd.DataFrame(
        {
            "specimen": np.array(whole.names)[whole.specimen],
            "temperature_C": whole.isotherm,
            "frequency_Hz": whole.frequency,
            "status": status,
            "reasons": why,
            "decided_by": [", ".join(one) for one in by],
        }
    )


def _is_in_law(status: NDArray) -> Rows:
    return np.isin(status, [USED, DOUBTFUL])


def kept(table: pd.DataFrame) -> Rows:
    """Which of the tests that the diagnosis used are in law.json and in what is reported."""
    status = table["status"].to_numpy()
    return _is_in_law(status[status != LEFT_OUT])


def told(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Entries `suspect_tests` of diagnosis.json: every test that is not simply used."""
    entries: list[dict[str, Any]] = table[table["status"] != USED].to_dict("records")
    return entries


def counts(table: pd.DataFrame, isotherms: Sequence[float]) -> dict[str, Any]:
    """Entry `trust` of diagnosis.json: how many tests can be used as they are, after a check, or not at all."""
    use, out = table["status"] == USED, table["status"] == LEFT_OUT
    check = ~use & ~out
    of = {
        "check_at_C": [float(t) for t in isotherms if not use[table["temperature_C"] == t].any()],
        "check_of": [name for name, own in use.groupby(table["specimen"]) if not own.any()],
    }
    columns = {"check_at_C": table["temperature_C"], "check_of": table["specimen"]}
    for name, column in columns.items():
        every = len(of[name]) == column.nunique()
        if not check.any() or every or (check & ~column.isin(of[name])).any():
            of[name] = []
    return {
        "use": int(use.sum()),
        "check": int(check.sum()),
        "held_back": int((table["status"] == HELD_BACK).sum()),
        "not_used": int(out.sum()),
        **of,
        "use_by_specimen": {str(name): int(own.sum()) for name, own in use.groupby(table["specimen"])},
    }


def _reasons(
    diagnosis: Diagnosis, whole: Observations, odd: Places
) -> Iterator[tuple[str, Rows, str, Sequence[str]]]:
    """Status, the tests (n,) that get it, what decides so, and why."""
    every = np.arange(whole.size)
    for one in diagnosis.suspects:
        yield DOUBTFUL if one.used else LEFT_OUT, every == one.row, ITSELF, one.reasons
    for entry in [*odd.moduli, *odd.phases]:
        yield HELD_BACK, levels.rows(whole, [entry]), "the other specimens", [levels.described(entry)[0]]
    for entry in odd.temperatures:
        side = "warmer" if entry["kelvin"] > 0.0 else "colder"
        reason = f"seems {abs(entry['kelvin']):.2g} K {side} than stated"
        yield HELD_BACK, levels.rows(whole, [entry]), "the other specimens", [reason]
    if odd.highest.any():
        yield HELD_BACK, odd.highest, "the other frequencies", ["off at this frequency in every specimen"]
    for entry in odd.contradictory:
        at = whole.isotherm == entry["temperature_C"]
        yield DOUBTFUL, at, "causality", ["phase and |E*| contradict each other at this temperature"]
    for entry in odd.off_target:
        away = abs(entry["measured_C"] - entry["temperature_C"])
        yield (
            DOUBTFUL,
            levels.rows(whole, [entry]),
            "the target temperature",
            [f"measured {away:.2g} K off target"],
        )
    above = quality.exceeded(whole)
    for value in above:
        if 2 * sum(other.column == value.column for other in above) >= whole.size:
            yield DOUBTFUL, every == value.row, "the machine's quality columns", [value.sentence]
