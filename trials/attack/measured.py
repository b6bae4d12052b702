"""Measured tables as campaigns into which faults can be put: the nine NCAT states, and a folder that the user names.

What a test would have been at another temperature or frequency is told by a quadratic in both, fitted to ln E*; only
its differences are used, so that the table keeps its own scatter and whatever else is in it.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pandas as pd

from .laboratory import BENDING, CYLINDER, Campaign
from .mixes import Complex, Vector

FOLDER = "ASPHALT_NSCD_TABLES"  # a folder of tables that may not be shipped
SHIPPED = Path(__file__).parents[2] / "data/ncat"
NAMES = {"replicate": "specimen", "T_C": "temperature_C", "f_Hz": "frequency_Hz", "phi_deg": "phase_deg"}
COLUMNS = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]


def paths() -> list[Path]:
    """Tables of moduli that are shipped, then those in the folder of the environment, by name."""
    given = os.environ.get(FOLDER)
    folders = [SHIPPED, *([Path(given)] if given else [])]
    found = [path for folder in folders for path in sorted(folder.rglob("*.csv"))]
    tables = {path.resolve(): path for path in found if _read(path) is not None}
    digests: dict[bytes, Path] = {}
    for path in tables.values():
        digests.setdefault(path.read_bytes(), path)  # a table that lies in both is tried once
    return list(digests.values())


def _read(path: Path) -> pd.DataFrame | None:
    try:
        table = pd.read_csv(path, comment="#").rename(columns=NAMES)
        return table[COLUMNS].astype({"specimen": str}) if set(COLUMNS) <= set(table) else None
    except (ValueError, OSError):
        return None


def campaign(path: Path, name: str) -> Campaign:
    """The table of a path. Bending is what a table of unknown bench is read as; NCAT's are cylinders."""
    table = _read(path)
    assert table is not None, path
    nominal = table["temperature_C"].round()
    tests = table[["specimen", "frequency_Hz"]].assign(temperature_C=nominal)[COLUMNS[:3]]
    base = np.log(table["E_MPa"].to_numpy(float) * 1e6) + 1j * np.radians(table["phase_deg"].to_numpy(float))
    t, x = tests["temperature_C"].to_numpy(float), np.log(tests["frequency_Hz"].to_numpy(float))
    centre = t.mean(), x.mean()

    def powers(t: Vector, x: Vector) -> np.ndarray:
        a, b = (t - centre[0]) / 20.0, (x - centre[1]) / 2.0
        return np.stack([np.ones_like(a), a, b, a * a, a * b, b * b], axis=1)

    smooth = np.linalg.lstsq(powers(t, x).astype(complex), base, rcond=None)[0]

    def response(warming: Vector, tuning: Vector) -> Complex:
        return base + (powers(t + warming, x + np.log(tuning)) - powers(t, x)) @ smooth

    shipped = SHIPPED in path.parents
    bench = CYLINDER if shipped or path.resolve().parent.name == CYLINDER else BENDING
    none = np.zeros(len(tests))
    return Campaign(name, bench, tests, response, none.astype(complex), none, about={"measured": True})
