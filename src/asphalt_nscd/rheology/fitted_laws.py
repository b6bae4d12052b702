"""The Burgers law of one temperature fitted to measurements."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
from asphalt_nscd.measurements.reduction import read_reduced, reduced_frame
from asphalt_nscd.measurements.tables import isotherm_rows
from asphalt_nscd.rheology.fitting import fit_burgers
from asphalt_nscd.rheology.laws_io import law_content


def fit_temperature(
    measured: str | Path,
    temperature: float,
    output: str | Path,
    geometry: str | Path | Mapping[str, Any] | None = None,
    cycles: int | None = None,
) -> dict[str, Any]:
    """Fit the Burgers law to all specimens at one temperature [degC], and write it as JSON.

    `measured` is a reduced table; with a `geometry` it is first reduced, as by `reduce_table`.
    """
    frame = (
        read_reduced(measured)
        if geometry is None
        else reduced_frame(read_csv(measured), geometry, cycles=cycles)
    )
    content = burgers_at(frame, temperature, str(measured))
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
