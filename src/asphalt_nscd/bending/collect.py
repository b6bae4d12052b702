"""Test files as one table."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import DamagedFile, InputError
from asphalt_nscd.files.store import load

COLUMNS = [
    "specimen",
    "temperature_C",
    "frequency_Hz",
    "spheres",
    "bonds",
    "broken_bonds",
    "steps",
    "E_MPa",
    "phase_deg",
    "E_peak_MPa",
    "phase_peak_deg",
    "E_law_MPa",
    "phase_law_deg",
    "residual",
]
SCALED = ["parameter", "factor"]


def collect(tests: Iterable[str | Path]) -> pd.DataFrame:
    """Tabulate test files, one row each in the order given: COLUMNS first, then whatever else they hold.

    A law source like "Em:0.5" (one parameter scaled, see `sensitivity`) gives two more columns.
    """
    rows = []
    for path in tests:
        attributes = load(path, "test").attributes
        missing = [name for name in COLUMNS if name not in attributes]
        if missing:
            raise DamagedFile(path, f"has no {', '.join(missing)}")
        rows.append(attributes)
    if not rows:
        raise InputError("no test files to collect; give at least one.")
    frame = pd.DataFrame(rows)
    scaled = frame["law_source"].str.extract(r"^(\w+):([\d.]+(?:e[+-]?\d+)?)$").set_axis(SCALED, axis=1)
    if scaled.notna().any(axis=None):
        frame = frame.assign(parameter=scaled["parameter"], factor=scaled["factor"].astype(float))
    return frame[[*COLUMNS, *(name for name in frame if name not in COLUMNS)]]
