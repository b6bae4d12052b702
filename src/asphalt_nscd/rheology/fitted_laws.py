"""The Burgers law of one temperature fitted to measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.reduction import read_reduced
from asphalt_nscd.measurements.tables import at_temperature
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.laws_io import write_law


def fit_temperature(measured: str | Path, temperature: float, output: str | Path) -> dict[str, Any]:
    """Fit the Burgers law to all specimens of a reduced table at one temperature [degC]; write it."""
    frame = read_reduced(measured)
    try:
        points = at_temperature(frame, temperature)
        modulus = points["E_MPa"] * 1e6 * np.exp(1j * np.radians(points["phase_deg"]))
        fit = fit_burgers(2.0 * np.pi * points["frequency_Hz"].to_numpy(), modulus.to_numpy())
    except InputError as error:
        raise InputError(f"{measured}, {temperature:g} degC: {error}") from None
    return write_law(
        output,
        fit.law,
        source="fitted",
        temperature=temperature,
        std_error=fit.std_error,
        rms_log_residual=fit.rms_log_residual,
    )
