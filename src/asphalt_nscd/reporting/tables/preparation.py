"""What pouring and vibrating made of each sample."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.files.store import load

OF_A_STAGE = [
    "solid_fraction",
    "periods",
    "periods_with_contact",
    "grains_touched_per_period",
    "coordination",
    "segregation",
    "largest_overlap_m",
    "largest_overlap_moving_m",
    "weight_balance",
    "unbalanced_force",
]


def make(deposits: list[Path]) -> pd.DataFrame:
    """Two rows for each sample, poured and vibrated; one where it was not vibrated.

    Overlaps are those at rest and the largest while grains fell or the wall was driven, in parts of the
    smallest radius.
    """
    rows = []
    for path in deposits:
        record = load(path, "deposit")
        found, radius = record.attributes, float(record.arrays["radius"].min())
        stages = {"poured": "poured_"} | ({"vibrated": ""} if found["vibration_s"] > 0.0 else {})
        for stage, prefix in stages.items():
            row: dict[str, Any] = {"sample": path.stem, "stage": stage}
            row["height_mm"] = 1e3 * found[f"{prefix}layer_height_m"]
            row |= {name: found[f"{prefix}{name}"] for name in OF_A_STAGE}
            # Over the smallest radius, as the rule of pouring says how much may stay.
            row["largest_overlap"] = row.pop("largest_overlap_m") / radius
            row["largest_overlap_moving"] = row.pop("largest_overlap_moving_m") / radius
            rows.append(row)
    return pd.DataFrame(rows)
