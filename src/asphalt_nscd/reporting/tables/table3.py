"""Table 3: Burgers parameters refitted to the measurements, beside the published ones."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import SAME_TEMPERATURE, isotherm_rows, origin_of, read_measured
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import read_published

PARAMETERS = {
    "Em": ("modulus_m", "Em_Pa", "MPa"),
    "eta_m": ("viscosity_m", "eta_m_Pa_s", "MPa s"),
    "Ek": ("modulus_k", "Ek_Pa", "MPa"),
    "eta_k": ("viscosity_k", "eta_k_Pa_s", "MPa s"),
}
MEGA = 1e-6


def make(fitted: list[Path], measured: list[Path], published: Sequence[Path] = ()) -> pd.DataFrame:
    """One row for each temperature and parameter, in MPa or MPa s; published numbers are read in kPa."""
    data = read_measured(measured)
    printed: dict[float, Any] = {}
    for path in published:
        printed |= dict(zip(*read_published(path), strict=True))
    rows = []
    for path in fitted:
        content, law = read_json(path), read_law(path)
        temperature = content["temperature_C"]
        if content.get("source") != "fitted":
            raise InputError(f"{path}: a law that was not fitted; give fitted laws.")
        known = next((law for t, law in printed.items() if abs(t - temperature) < SAME_TEMPERATURE), None)
        for name, (field, key, unit) in PARAMETERS.items():
            rows.append(
                {
                    "temperature_C": temperature,
                    "parameter": name,
                    "unit": unit,
                    "published": getattr(known, field) * MEGA if known else np.nan,
                    "fitted": getattr(law, field) * MEGA,
                    # as many unknowns as data leave no standard error
                    "standard_error": content["std_error"][key] * MEGA if content["std_error"] else np.nan,
                    "fitted_to": origin_of(isotherm_rows(data, temperature)),
                }
            )
    table = pd.DataFrame(rows).sort_values("temperature_C", kind="stable", ignore_index=True)
    ratio = table["fitted"] / table["published"]
    table.insert(6, "fitted_over_published", ratio)
    return table if published else table.drop(columns=["published", "fitted_over_published"])
