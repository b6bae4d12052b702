"""What is numerics in a campaign of simulated tests: steps and transient, broken bonds, peak picking."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.observed.observations import Vector
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.tables import read_tests

# A study simulates the nominal conditions of what was measured.
NEAR_DEGREES = 1.0
NEAR_FREQUENCY = 0.1  # relative


def numerical_errors(
    simulations: str | Path, temperatures: Vector, frequencies: Vector
) -> dict[str, float | int]:
    """Largest departures of simulated tests from what is no numerics, of |E*| [%] and of the phase [degrees].

    time_stepping: from the law of the bonds times the specimen's own ratio, tests without broken bonds; broken_bonds:
    the same in the others; peak_picking: of the paper's reduction from the harmonic fit. Measured tests are at
    `temperatures` [degC] and `frequencies` [Hz], (n,); refused where none of them was simulated.
    """
    tests = read_tests([simulations], ["broken_bonds", "E_peak_MPa", "phase_peak_deg"])
    near = np.abs(tests["temperature_C"].to_numpy()[:, None] - temperatures) <= NEAR_DEGREES
    near &= np.abs(np.log(tests["frequency_Hz"].to_numpy()[:, None] / frequencies)) <= NEAR_FREQUENCY
    if not near.any():
        raise InputError(
            f"{simulations}: no test at a temperature and frequency that was measured; "
            "give the simulations of these measurements."
        )
    whole = tests["broken_bonds"] == 0
    relative = np.log(tests["E_MPa"] / tests["E_law_MPa"])
    # The packing's own ratio to its law is no numerics.
    relative -= tests["specimen"].map(relative[whole].groupby(tests["specimen"]).median())
    turned = tests["phase_deg"] - tests["phase_law_deg"]
    found: dict[str, float | int] = {"tests": len(tests), "tests_with_broken_bonds": int((~whole).sum())}
    for name, rows in (("time_stepping", whole), ("broken_bonds", ~whole)):
        found |= _largest(name, relative[rows], turned[rows])
    peaks = np.log(tests["E_peak_MPa"] / tests["E_MPa"]), tests["phase_peak_deg"] - tests["phase_deg"]
    return found | _largest("peak_picking", *peaks)


def _largest(name: str, relative: pd.Series, turned: pd.Series) -> dict[str, float]:
    return {
        f"{name}_modulus_percent": 100.0 * float(relative.abs().max()) if relative.notna().any() else 0.0,
        f"{name}_phase_deg": float(turned.abs().max()) if turned.notna().any() else 0.0,
    }
