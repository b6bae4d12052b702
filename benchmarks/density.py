"""What decides how dense a poured layer is: height of the drop and friction of the walls.

    python benchmarks/density.py data/paper/table2_counts.csv --output DENSITY.csv

2266 spheres of the paper's grading in a box of 40 x 25 mm, without vibration, four seeds each. The lattice from which
they fall fills the box, so that the box's height is that of the drop. Writes the mean of the
seeds, and the standard deviation of their solid fractions (scatter).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import write_table
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.preparation import pour
from asphalt_nscd.specimen.settings import Pouring, Surfaces, Vibration

SHARE = 0.16  # of the paper's counts, as the area of the box is of the paper's
LENGTH, WIDTH = 0.04, 0.025  # m
KINDS = [(1.6, None), (0.8, None), (0.5, None), (1.6, 0.0)]  # height of the box [m], friction of walls
SEEDS = (1, 2, 3, 4)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("counts", type=Path)
    parser.add_argument("--output", required=True)
    told = parser.parse_args()
    diameters, counts = read_counts(told.counts)
    spheres = diameters, (SHARE * counts + 0.5).astype(int)
    rows = []
    for height, wall_friction in KINDS:
        for seed in SEEDS:
            surfaces = Surfaces(wall_friction=wall_friction)
            fallen = Pouring((LENGTH, WIDTH, height), seed, surfaces, Vibration(duration=0.0))
            said = pour(spheres, fallen)[1]
            rows.append({
                "drop_m": height, "wall_friction": said["wall_friction"], "seed": seed,
                "height_mm": 1e3 * said["layer_height_m"], "solid_fraction": said["solid_fraction"],
                "coordination": said["coordination"],
            })  # fmt: skip
    table = pd.DataFrame(rows).drop(columns="seed").groupby(["drop_m", "wall_friction"], sort=False)
    mean = table.mean()
    mean.insert(2, "scatter", table["solid_fraction"].std())
    write_table(told.output, mean.reset_index())


if __name__ == "__main__":
    main()
