"""Levels of |E*| that are odd: one specimen at one temperature, or specimens that are hardly of one mix.

A wrong diameter, gain or unit of one test series leaves modulus and phase in agreement with each other, so that
causality says nothing of it. The specimen's other isotherms and the other specimens do.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.scatter import median_by
from asphalt_nscd.files.words import specimen_named

LEAST = 3  # specimens of an isotherm, and isotherms of a specimen: of two, neither is the odd one
FAR, DEVIATIONS = 0.2, 5.0  # of ln|E*|, and times the usual deviation, above which a level is odd
NORMAL = 1.4826  # standard deviation over the median absolute deviation
ONE_MIX = 25.0  # percent by which specimens of one mix hardly differ; T 378 expects some 13


def odd(observed: Observations) -> list[dict[str, Any]]:
    """Specimen, temperature [degC] and factor of |E*| of each isotherm off the level of its specimen."""
    apart = observed.logarithm.real - median_by(observed.logarithm.real, observed.cell)
    level: dict[tuple[int, float], float] = {}
    for t in observed.isotherms:
        at = observed.isotherm == t
        specimens = np.unique(observed.specimen[at])
        if specimens.size >= LEAST:
            level |= {
                (int(k), float(t)): float(np.median(apart[at & (observed.specimen == k)])) for k in specimens
            }
    own = {k: [value for (other, _), value in level.items() if other == k] for k, _ in level}
    left = {
        place: value - float(np.median(own[place[0]]))
        for place, value in level.items()
        if len(own[place[0]]) >= LEAST
    }
    if not left:
        return []
    usual = NORMAL * float(np.median(np.abs(list(left.values()))))
    return [
        {"specimen": observed.names[k], "temperature_C": t, "factor": float(np.exp(value))}
        for (k, t), value in left.items()
        if abs(value) > max(FAR, DEVIATIONS * usual)
    ]


def notes(found: list[dict[str, Any]]) -> list[str]:
    """Sentences on odd levels."""
    return [
        f"At {one['temperature_C']:g} degC |E*| of {specimen_named(one['specimen'])} is {one['factor']:.2g} "
        "times what its other isotherms and the other specimens say. Modulus and phase may agree all the same. "
        "Check dimensions, gain and unit of these tests."
        for one in found
    ]
