"""Are packings of the same kind after a change of the pouring? One row for each deposit file.

    python benchmarks/packings.py before=OLD.h5 after=NEW.h5... --output PACKINGS.csv

The same counts, box and seeds by two versions of `asphalt-nscd deposit`; what it wrote into the files is compared.
Prints the table in Markdown, with the mean and the scatter of the seeds where there are several.
"""

from __future__ import annotations

import argparse

import pandas as pd

from asphalt_nscd.files.store import load, write_table

QUANTITIES = [
    "poured_mm", "vibrated_mm", "solid_fraction", "coordination", "overlap_at_rest", "overlap_falling",
    "overlap_vibrating", "weight_balance", "unbalanced_force",
]  # fmt: skip


def row(version: str, path: str) -> dict[str, object]:
    """Overlaps in parts of the smallest radius; weight_balance: force on floor and walls over the weight, less 1."""
    record = load(path, "deposit")
    found, smallest = record.attributes, float(record.arrays["radius"].min())
    return {
        "version": version,
        "spheres": found["spheres"],
        "seed": found["seed"],
        "poured_mm": 1e3 * found["poured_layer_height_m"],
        "vibrated_mm": 1e3 * found["layer_height_m"],
        "solid_fraction": found["solid_fraction"],
        "coordination": found["coordination"],
        "overlap_at_rest": found["largest_overlap_m"] / smallest,
        "overlap_falling": found["poured_largest_overlap_moving_m"] / smallest,
        "overlap_vibrating": found["largest_overlap_moving_m"] / smallest,
        "weight_balance": found["weight_balance"],
        "unbalanced_force": found["unbalanced_force"],
    }


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Mean of the seeds, and half their range where there are several, by number of spheres and version."""
    rows = []
    for (spheres, version), group in table.groupby(["spheres", "version"], sort=False):
        told = {"spheres": spheres, "version": version, "seeds": len(group)}
        for name in QUANTITIES:
            half = 0.5 * (group[name].max() - group[name].min())
            told[name] = f"{group[name].mean():.4g}" + (f" ± {half:.1g}" if len(group) > 1 else "")
        rows.append(told)
    return pd.DataFrame(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("deposits", nargs="+", metavar="VERSION=DEPOSIT.h5")
    parser.add_argument("--output", required=True)
    told = parser.parse_args()
    table = pd.DataFrame([row(*deposit.split("=", 1)) for deposit in told.deposits])
    write_table(told.output, table)
    short = summary(table)
    lines = [list(short.columns), ["---"] * len(short.columns), *short.astype(str).to_numpy().tolist()]
    print("\n".join("| " + " | ".join(line) + " |" for line in lines))


if __name__ == "__main__":
    main()
