"""The Burgers law of one temperature fitted to measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
from asphalt_nscd.measurements.reduction import read_reduced
from asphalt_nscd.measurements.tables import isotherm_rows
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.laws_io import law_content


def fit_temperature(measured: str | Path, temperature: float, output: str | Path) -> dict[str, Any]:
    """Fit the Burgers law to all specimens of a reduced table at one temperature [degC], and write it as JSON."""
    content = burgers_at(read_reduced(measured), temperature, str(measured))
    write_json(output, content)
    return content


def burgers_at(frame: pd.DataFrame, temperature: float, name: str) -> dict[str, Any]:
    """Content of the file of the Burgers law fitted to one temperature [degC]; `name` is for a refusal."""
    try:
        points = isotherm_rows(frame, temperature)
        modulus = points["E_MPa"] * 1e6 * np.exp(1j * np.radians(points["phase_deg"]))
        fit = fit_burgers(2.0 * np.pi * points["frequency_Hz"].to_numpy(), modulus.to_numpy())
    except InputError as error:
        raise InputError(f"{name}, {temperature:g} degC: {error}") from None
    return law_content(
        fit.law,
        source="fitted",
        temperature=temperature,
        std_error=fit.std_error,
        rms_log_residual=fit.rms_log_residual,
    )
