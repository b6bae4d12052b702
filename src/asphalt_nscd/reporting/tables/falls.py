"""Where the energy of a fall goes, for time steps that grow shorter."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import load

PARTS = ("kinetic", "springs", "dashpots", "impact", "friction", "fracture", "numerical", "turning")


def make(fall: list[Path]) -> pd.DataFrame:
    """A row for each fall; shares in percent of the energy set free until its end."""
    rows = []
    for path in fall:
        told = load(path, "fall").attributes
        rows.append(
            {
                "time_step_ms": 1e3 * told["time_step_s"],
                "energy_mJ": 1e3 * told["energy_J"],
                **{f"{part}_%": told[f"{part}_percent"] for part in PARTS},
                "error_%": told["error_percent"],
                "fragments": told["fragments"],
                "broken_bonds": told["broken_bonds"],
                "speed_at_end_m_s": told["speed_m_s"],
            }
        )
    return pd.DataFrame(rows).sort_values("time_step_ms", ascending=False, ignore_index=True)
