"""Air voids, VMA and VFA where a laboratory gives them: what they say of the glassy modulus and of the specimens."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.rheology.hirsch import limiting_modulus

# Change of ln|E*| by one percent of air voids: -0.05 to -0.08 by Hirsch and Witczak between 4 and 40 degC.
SLOPE, SLOPE_ERROR = -0.06, 0.03
COLUMNS = ("air_voids_percent", "vma_percent", "vfa_percent")


@dataclass(frozen=True)
class Volumetrics:
    """VMA and VFA of the mix in percent, if both are known, and air voids of the specimens in percent."""

    of_mix: tuple[float, float] | None = None
    air_voids: Mapping[str, float] = field(default_factory=dict)

    @property
    def note(self) -> list[str]:
        """What is made of VMA and VFA, in a sentence."""
        if self.of_mix is None:
            return []
        vma, vfa = self.of_mix
        return [
            f"VMA {vma:.3g} % and VFA {vfa:.3g} %: the glassy modulus of law.json is held near "
            f"{limiting_modulus(vma, vfa) * 1e-9:.1f} GPa, the limiting modulus of AASHTO R 84."
        ]


def read_volumetrics(table: Table | None, vma: float | None = None, vfa: float | None = None) -> Volumetrics:
    """Of the columns of a table, means of each specimen and of the mix; `vma` and `vfa` [%] come before these."""
    named = [name for name in COLUMNS if table is not None and name in table.columns]
    if table is None or not named or "specimen" not in table.columns:
        return Volumetrics(None if vma is None or vfa is None else (vma, vfa))
    rows = pd.DataFrame({name: table.numbers_or_nan(name) for name in named})
    means = rows.groupby(np.array(table.text("specimen"))).mean()
    mix = [
        given if given is not None else float(means[name].mean()) if name in means else np.nan
        for given, name in zip((vma, vfa), COLUMNS[1:], strict=True)
    ]
    air = means[COLUMNS[0]].dropna().to_dict() if COLUMNS[0] in means else {}
    return Volumetrics((mix[0], mix[1]) if np.isfinite(mix).all() else None, air)


def explained(diagnosis: Diagnosis, volumetrics: Volumetrics) -> dict[str, Any] | None:
    """What air voids explain of the levels of the specimens; None where fewer than two specimens have them."""
    names, given = diagnosis.observed.names, volumetrics.air_voids
    rows = [k for k, name in enumerate(names) if name in given]
    air = np.array([given[names[k]] for k in rows])
    if air.size < 2 or np.ptp(air) == 0.0:
        return None
    level, away = diagnosis.law_of_all()[1].scales[rows], air - air.mean()
    level = level - level.mean()
    # Least squares beside what is usual: few specimens hardly determine a slope.
    weight = float(away @ away) / diagnosis.noise.scale**2
    precision = weight + SLOPE_ERROR**-2
    slope = (float(away @ level) / diagnosis.noise.scale**2 + SLOPE / SLOPE_ERROR**2) / precision
    before, after = (100.0 * float(np.std(x, ddof=1)) for x in (level, level - slope * away))
    return {
        "slope_percent": 100.0 * slope,
        "std_error_percent": 100.0 * precision**-0.5,
        "specimens_percent": before,
        "left_percent": after,
        "lowest_percent": float(air.min()),
        "highest_percent": float(air.max()),
    }
