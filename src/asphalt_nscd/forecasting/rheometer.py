"""A sweep of a shear rheometer: what it must hold to be that of a binder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.csvinput import Limits, Table, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.slips import units_of_labels

WANTED = "give columns temperature (C), frequency (Hz) or omega (rad/s), G* (Pa) and phase (deg), units in their names"
COLUMNS = {
    "temperature_C": Limits(-60.0, 120.0, "give it in degC"),
    "frequency_Hz": Limits(1e-9, 1e6, "give it in Hz or rad/s as its column says, above zero"),
    "G_MPa": Limits(1e-9, 5e3, "give |G*| in Pa, kPa or MPa as its column says, above zero"),
    "phase_deg": Limits(0.0, 90.0 + 1e-6, "give it in degrees, 0 to 90"),
}
TableReader = Callable[[Path], Table]


def read_rheometer(
    path: Path, read_table: TableReader = read_csv
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Temperature [degC], angular frequency [rad/s] and G* [Pa] of each point (n,).

    `read_table` gives a file under the names of COLUMNS: a plain one, or as rheometers write it (`table_import.shear`).
    """
    table = read_table(path)
    table.require(COLUMNS)
    sweep = pd.DataFrame({name: table.numbers(name, limits) for name, limits in COLUMNS.items()})
    for slip in units_of_labels(sweep):
        raise InputError(f"{path}: {slip}")
    # In radians a phase is 1.57 at most, and no binder stays below 2 degrees in all of a table.
    if sweep["phase_deg"].max() < 2.0:
        raise InputError(f"{path}: the phase is {sweep['phase_deg'].max():.3g} at most; give it in degrees.")
    temperature, frequency, size, phase = sweep.to_numpy().T
    return temperature, 2.0 * np.pi * frequency, 1e6 * size * np.exp(1j * np.radians(phase))
