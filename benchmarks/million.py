"""What a layer of a million spheres would take on a node of 32 cores: an estimate from what was measured.

    python benchmarks/million.py LAYER.csv GROWTH.csv THREADS.csv --output MILLION.csv

Times of the large layer grow with the exponents between the two largest sizes. The share of the pouring that threads
do not make faster is that of Amdahl's law on the threads measured (the slower of both works).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import write_table

SPHERES, MEASURED, CORES = 1_000_000, 200_000, 32
GROWS_LIKE = {  # stages of the layer, and of growth.py
    "pour and vibrate": ("pour and settle", "vibrate"),
    "trim and bond": ("trim and bond",),
    "condense": ("condense",),
    "one test": ("reduced, a cycle",),
}


def faster(threads: pd.DataFrame, cores: int) -> float:
    """Times as fast as one thread, by Amdahl's law."""
    slowest = threads.loc[threads["speed_up"].idxmin()]
    measured, speed_up = float(slowest["threads"]), float(slowest["speed_up"])
    serial = max(measured / speed_up - 1.0, 0.0) / (measured - 1.0)
    return 1.0 / (serial + (1.0 - serial) / cores)


def estimated(layer: pd.DataFrame, growth: pd.DataFrame, threads: pd.DataFrame) -> pd.DataFrame:
    """One row for each stage of the layer."""
    growth = growth.set_index("stage")
    ratio, rows = SPHERES / MEASURED, []
    for _, row in layer.iterrows():
        alike = growth.loc[list(GROWS_LIKE[row["stage"].split(",")[0]])]
        exponent = float(alike["last_exponent_of_time"].max())
        used = row["threads"] if pd.notna(row["threads"]) else 1.0
        cores = CORES if used > 1.0 else 1
        speed_up = faster(threads, cores)
        one_thread = row["wall_s"] * faster(threads, int(used))
        memory = row["memory_MB"] * ratio ** float(alike["last_exponent_of_memory"].max())
        rows.append(
            {
                "stage": row["stage"],
                "exponent_of_time": exponent,
                "threads": cores,
                "speed_up": speed_up,
                "wall_h": one_thread * ratio**exponent / speed_up / 3600.0,
                "memory_GB": memory / 1024.0,
            }
        )
    return pd.DataFrame(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("layer", "growth", "threads"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    write_table(told.output, estimated(*map(pd.read_csv, (told.layer, told.growth, told.threads))))


if __name__ == "__main__":
    main()
