"""A table of a shear rheometer as laboratories export it: temperature, frequency, |G*| and phase, in any usual unit."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from asphalt_nscd.files.csvinput import Limits, Table, read_csv
from asphalt_nscd.files.errors import InputError

# What a column holds: words in its name; factor and offset to degC, rad/s, Pa and rad by its unit.
COLUMNS = {
    "temperature": (r"temp", {"c": (1.0, 0.0), "k": (1.0, -273.15), "f": (5 / 9, -160 / 9)}),
    "frequency": (r"freq|omega|ω", {"hz": (2.0 * np.pi, 0.0), "rad/s": (1.0, 0.0), "rad_s": (1.0, 0.0)}),
    "modulus": (
        r"^\|?g\*?\|?$|g\*|complex.*modulus",
        {"pa": (1.0, 0.0), "kpa": (1e3, 0.0), "mpa": (1e6, 0.0)},
    ),
    "phase": (r"phase|delta|δ", {"deg": (np.pi / 180.0, 0.0), "°": (np.pi / 180.0, 0.0), "rad": (1.0, 0.0)}),
}
OTHER = r"viscosity|tan|target|set"  # of a name that is none of these
LIMITS = {
    "temperature": Limits(-60.0, 120.0, "give it in degC"),
    "frequency": Limits(1e-8, 1e7, "give it in Hz or rad/s, above zero"),
    "modulus": Limits(1e-3, 5e9, "give |G*| in Pa, kPa or MPa as its column says, above zero"),
    "phase": Limits(0.0, 0.5 * np.pi + 1e-9, "give it in degrees, 0 to 90"),
}


def read_rheometer(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Temperature [degC], angular frequency [rad/s] and G* [Pa] of each row (n,)."""
    table = read_csv(path)
    found = {kind: _numbers(table, path, kind) for kind in COLUMNS}
    # In radians a phase is 1.57 at most, and no binder stays below 2 degrees in all of a table.
    if found["phase"].max() < np.radians(2.0):
        raise InputError(
            f"{path}: the phase is {np.degrees(found['phase'].max()):.3g} at most; give it in degrees."
        )
    return found["temperature"], found["frequency"], found["modulus"] * np.exp(1j * found["phase"])


def _numbers(table: Table, path: Path, kind: str) -> np.ndarray:
    """The column of a kind, in degC, rad/s, Pa or rad."""
    words, units = COLUMNS[kind]
    for name in table.columns:
        told = re.fullmatch(
            rf"(.*?)[\s_,/]*[(\[]?(?:°(?=[CF]))?({'|'.join(units)})[)\]]?", name.strip(), re.IGNORECASE
        )
        if told and re.search(words, told[1], re.IGNORECASE) and not re.search(OTHER, told[1], re.IGNORECASE):
            factor, offset = units[told[2].lower()]
            low, high = ((bound - offset) / factor for bound in (LIMITS[kind].low, LIMITS[kind].high))
            return factor * table.numbers(name, Limits(low, high, LIMITS[kind].mend)) + offset
    raise InputError(
        f"{path}: no column of {kind} with its unit; give one whose name has it, as temperature_C, frequency_Hz or "
        f"angular_frequency_rad_s, G_Pa, phase_deg."
    )
