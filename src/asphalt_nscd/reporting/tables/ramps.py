"""What ramps to failure show, and how much of it the time step makes."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.bending.ramp import RAMP
from asphalt_nscd.files.store import load


def make(ramp: list[Path]) -> pd.DataFrame:
    """A column for each ramp, the longest time step first; the change of its peak is against the one before."""
    told = sorted((load(path, RAMP).attributes for path in ramp), key=lambda each: -each["time_step_s"])
    peaks = pd.Series([each["peak_force_N"] for each in told])
    rows: dict[str, list[float]] = {
        "largest force, N": peaks.tolist(),
        "against twice the step, %": (100.0 * peaks.pct_change()).tolist(),
        "displacement there, um": [1e6 * each["displacement_at_peak_m"] for each in told],
        "bonds broken there": [each["broken_at_peak"] for each in told],
        "bonds broken in the end": [each["broken_bonds"] for each in told],
        "bonds": [each["bonds"] for each in told],
        "missed by the account of energy, % of the work": [100.0 * each["energy_error"] for each in told],
        "taken by breaks, % of the work": [
            100.0 * each["energy_fracture_J"] / each["energy_actuator_J"] for each in told
        ],
        "CPU time, s": [each["cpu_s"] for each in told],
    }
    names = [f"{1e3 * each['time_step_s']:g} ms" for each in told]
    return pd.DataFrame.from_dict(rows, orient="index", columns=names).rename_axis("steps of").reset_index()
