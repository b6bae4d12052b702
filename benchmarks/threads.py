"""How much faster several threads pour: the same steps on one thread and on more, in turns; medians of wall time.

    python benchmarks/threads.py SPHERES COUNTS --threads 2 --output ROWS.csv

Spheres of the paper's grading in a box scaled alike. Measured are steps in the rain and under the vibrating wall.
Wall time counts here, so the machine has to be quiet; where it is not, the spread of the pairs says so.
"""

from __future__ import annotations

import argparse
import time
from copy import deepcopy
from pathlib import Path

import numpy as np
import pandas as pd
from growth import BOX

from asphalt_nscd.files.store import write_table
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.deposit import REST_SPEED, PouringHistory, Vibration, settle, vibrate
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.preparation import DENSITY, LONGEST_POURING

FRICTION, TIME_STEP = 0.2, 4e-4  # -, s
FALL = 0.25  # s, when half of the grains have landed
FALLING_STEPS, VIBRATED = 50, 0.04  # steps; s, more than a period
PAIRS = 5


def silent(*_: object) -> None:
    """No progress is told."""


def fall(bed: GranularBed, numerics: PouringNumerics) -> None:
    for _ in range(FALLING_STEPS):
        bed.advance(numerics)


def shake(bed: GranularBed, numerics: PouringNumerics) -> None:
    pressure = bed.weight() / (bed.plane_point[3, 0] * bed.plane_point[4, 1])
    vibrate(bed, numerics, Vibration(duration=VIBRATED), pressure, PouringHistory(), silent)


def measured(bed: GranularBed, numerics: PouringNumerics, work, threads: int) -> tuple[float, bytes]:
    """Wall time [s] of the same work from the same state, and what came of it."""
    copy = deepcopy(bed)
    copy._workspace = None  # rows of a copy do not begin at cache lines, as those of a pouring do
    copy._list(copy._start, copy._other)
    copy.impulse = bed.impulse
    with Team(threads) as copy.team:
        copy.advance(numerics)
        began = time.perf_counter()
        work(copy, numerics)
        return time.perf_counter() - began, copy.position.tobytes() + copy.impulse.tobytes()


def compared(name: str, bed: GranularBed, numerics: PouringNumerics, work, threads: int) -> dict[str, object]:
    """A row: how many times faster so many threads are."""
    ratios, walls = [], []
    for _ in range(PAIRS):
        one, single = measured(bed, numerics, work, 1)
        more, several = measured(bed, numerics, work, threads)
        if single != several:
            raise ArithmeticError(f"{name}: one thread and {threads} give different numbers")
        ratios.append(one / more)
        walls.append(one)
    return {
        "work": name,
        "spheres": bed.radius.size,
        "threads": threads,
        "speed_up": float(np.median(ratios)),
        "lowest": min(ratios),
        "highest": max(ratios),
        "wall_s_of_one": float(np.median(walls)),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spheres", type=int)
    parser.add_argument("counts", type=Path)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    diameters, counts = read_counts(told.counts)
    share = told.spheres / counts.sum()
    box = tuple(share ** (1.0 / 3.0) * side for side in BOX)
    position, radius = random_lattice(
        diameters, np.rint(counts * share).astype(int), box, np.random.default_rng(1)
    )
    numerics = PouringNumerics.of(radius, TIME_STEP)
    bed = GranularBed.in_box(position, radius, box, DENSITY, FRICTION)
    bed.let_fall()
    with Team(told.threads) as team:
        bed.team = team
        while bed.time < FALL:
            bed.advance(numerics)
        bed.team = Team()
        falling = deepcopy(bed)
        bed.team = team
        settle(bed, numerics, REST_SPEED, LONGEST_POURING, silent, "")
        bed.team = Team()
    rows = [
        compared("falling", falling, numerics, fall, told.threads),
        compared("vibrating", bed, numerics, shake, told.threads),
    ]
    write_table(told.output, pd.DataFrame(rows))


if __name__ == "__main__":
    main()
