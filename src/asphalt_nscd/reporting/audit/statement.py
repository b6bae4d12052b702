"""One audited statement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

REPRODUCED = "reproduced"
DIFFERS = "differs"
INCONSISTENT = "inconsistent in itself"
UNCHECKED = "cannot be checked"


@dataclass(frozen=True)
class Statement:
    """A row of audit.csv; values are words or numbers with the unit in `unit`."""

    where: str  # section, equation, table or figure of the paper
    statement: str
    published: str | float
    ours: str | float
    unit: str
    verdict: str
    evidence: str


def compared(
    where: str, statement: str, published: float, ours: float, unit: str, tolerance: float, evidence: str
) -> Statement:
    """A number against a number: reproduced when they agree within the relative tolerance."""
    agrees = abs(ours - published) <= tolerance * abs(published)
    evidence = f"{evidence} Counts as reproduced within {100.0 * tolerance:g} %."
    return Statement(where, statement, published, ours, unit, REPRODUCED if agrees else DIFFERS, evidence)


def spanned(values: Sequence[float] | NDArray[np.float64], form: str) -> str:
    """The range of values; one number where both ends read alike."""
    low, high = f"{min(values):{form}}", f"{max(values):{form}}"
    return low if low == high else f"{low} to {high}"


def judged(holds: bool) -> str:
    """Verdict on a statement that either holds or does not."""
    return REPRODUCED if holds else DIFFERS
