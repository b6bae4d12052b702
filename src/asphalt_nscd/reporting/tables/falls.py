"""Where the energy of a fall goes, for time steps that grow shorter."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.bending.fall import PARTS
from asphalt_nscd.files.store import load


def make(fall: list[Path]) -> pd.DataFrame:
    """A column for each fall, the longest time step first; shares are of the energy set free until its end."""
    told = sorted((load(path, "fall").attributes for path in fall), key=lambda one: -one["time_step_s"])
    rows: dict[str, list[float]] = {
        "energy set free, mJ": [1e3 * one["energy_J"] for one in told],
        **{f"{part}, %": [one[f"{part}_percent"] for one in told] for part in PARTS},
        "missing, %": [one["error_percent"] for one in told],
        "pieces": [one["fragments"] for one in told],
        "bonds broken by the fall": [one["broken_bonds"] for one in told],
        "fastest sphere at the end, m/s": [one["speed_m_s"] for one in told],
    }
    names = [f"{1e3 * one['time_step_s']:g} ms" for one in told]
    return pd.DataFrame.from_dict(rows, orient="index", columns=names).rename_axis("steps of").reset_index()
