"""What the testing machine itself says of a test, held against the limits of the standard."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import joined, specimen_named

STANDARD = "AASHTO T 378, TP 132"
SPECIMEN, MACHINE = "the gauges and the ends of the specimens", "the control of the machine"


@dataclass(frozen=True)
class Limit:
    """Largest value that the standard accepts, in `unit` ("%" or "deg"), and what to check where most exceed it."""

    limit: float
    unit: str
    label: str
    check: str


@dataclass(frozen=True)
class Exceeded:
    """One test (row of the observations) whose quality column is above its limit, in the column's unit."""

    row: int
    column: str
    value: float
    limit: float

    @property
    def sentence(self) -> str:
        """What the machine gave and the limit."""
        of = LIMITS[self.column]
        return f"{of.label} {self.value:.3g} {of.unit} (limit {self.limit:g})"


# Drift of load and deformation is kept but not judged: no number of the standard could be checked for it, and the
# sign that means "in the direction of the load" differs from machine to machine.
LIMITS: dict[str, Limit] = {
    "load_standard_error_percent": Limit(10.0, "%", "load standard error", MACHINE),
    "deformation_standard_error_percent": Limit(10.0, "%", "deformation standard error", SPECIMEN),
    "deformation_uniformity_percent": Limit(30.0, "%", "deformation uniformity", SPECIMEN),
    "phase_uniformity_deg": Limit(3.0, "deg", "phase uniformity", SPECIMEN),
}
UNLIMITED = ("load_drift_percent", "deformation_drift_percent")
COLUMNS = (*LIMITS, *UNLIMITED)


def exceeded(observed: Observations) -> list[Exceeded]:
    """Every quality value above its limit, by row and then in the order of LIMITS; NaN exceeds nothing."""
    found = [
        Exceeded(int(row), name, float(observed.quality[name][row]), limit.limit)
        for name, limit in LIMITS.items()
        if name in observed.quality
        for row in np.flatnonzero(observed.quality[name] > limit.limit)
    ]
    return sorted(found, key=lambda one: one.row)


def where(observed: Observations, column: str) -> str:
    """Specimens, each at the isotherms where half of its tests or more exceed the limit of a column, in words."""
    rows = [one.row for one in exceeded(observed) if one.column == column]
    above = np.isin(np.arange(observed.size), rows)
    places, parts = [], []
    for k, name in enumerate(observed.names):
        own = observed.specimen == k
        isotherms = np.unique(observed.isotherm[own])
        at = [f"{t:g}" for t in isotherms if above[own & (observed.isotherm == t)].mean() >= 0.5]
        if len(at) == isotherms.size:
            places.append(name)
        elif at:
            parts.append(f"{specimen_named(name)} at {joined(at)} degC")
    alike = len(places) > 1 and not places[0].casefold().startswith("specimen")
    return joined(
        [f"specimens {joined(places)}" if alike else joined(list(map(specimen_named, places))), *parts]
    )
