"""The scatter of a campaign as a laboratory quotes it: coefficients of variation, by isotherm.

Between specimens: how far specimens differ at one temperature and frequency. Within specimens: how far the tests of one
specimen scatter about its own level, which is taken off together with the mean of each condition. Both in percent of
|E*| and in degrees of phase, root mean square over the frequencies of an isotherm.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed.apart import furthest
from asphalt_nscd.diagnosis.observed.observations import Observations, Vector
from asphalt_nscd.diagnosis.observed.scatter import unexplained


def coefficients(observed: Observations, kept: NDArray[np.bool_] | None = None) -> dict[str, Any] | None:
    """Coefficients of variation `between` and `within` specimens, for all tests and by isotherm; who is `furthest`.

    `within` is of the tests (n,) that are `kept`, or of all: it judges repeats of the others, which a delay, say,
    scatters as no repeat does. Each is {"E_percent", "phase_deg"}; `within` is None where it cannot be told from the
    specimens' levels. The whole is None where nothing was repeated.
    """
    rows = {
        float(t): found
        for t in observed.isotherms
        if (found := _isotherm(observed.subset(observed.isotherm == t))) is not None
    }
    if kept is not None:
        for t, found in rows.items():
            sound = kept & (observed.isotherm == t)
            left = _isotherm(observed.subset(sound)) if sound.any() else None
            found["within"] = (np.zeros(2), 0) if left is None else left["within"]
    if not rows:
        return None
    return {
        "furthest": furthest(observed),
        **{way: _pooled([row[way] for row in rows.values()]) for way in ("between", "within")},
        "by_isotherm": [
            {"temperature_C": t, **{way: _pooled([row[way]]) for way in ("between", "within")}}
            for t, row in rows.items()
        ],
    }


def _isotherm(at: Observations) -> dict[str, tuple[Vector, int]] | None:
    """Sums of squares (2,) of ln|E*| and phase [rad], with their degrees of freedom."""
    cell = np.unique(at.cell, return_inverse=True)[1]
    specimen = np.unique(at.specimen, return_inverse=True)[1]
    values = np.column_stack([at.logarithm.real, at.logarithm.imag])
    conditions = np.eye(cell.max() + 1)[cell]
    between = _residual_squares(conditions, values)
    if between[1] < 1:
        return None
    levels = np.hstack([conditions, np.eye(specimen.max() + 1)[specimen]])
    return {"between": between, "within": _residual_squares(levels, values)}


def _residual_squares(design: NDArray, values: NDArray) -> tuple[Vector, int]:
    residual, freedom = unexplained(design, values)
    return (residual**2).sum(axis=0), freedom


def _pooled(parts: list[tuple[Vector, int]]) -> dict[str, float] | None:
    freedom = sum(count for _, count in parts)
    if freedom < 1:
        return None
    modulus, phase = np.sqrt(sum(squares for squares, _ in parts) / freedom)
    return {"E_percent": 100.0 * float(modulus), "phase_deg": float(np.degrees(phase))}
