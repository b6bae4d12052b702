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
from asphalt_nscd.specimen.deposit import REST_SPEED, Course, Shaking, settle, vibrate
from asphalt_nscd.specimen.granulate import Granulate, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.preparation import DENSITY, LONGEST_POURING, Vibration

FRICTION, TIME_STEP = 0.2, 4e-4  # -, s
FALL = 0.25  # s, when half of the grains have landed
FALLING_STEPS, VIBRATED = 50, 0.04  # steps; s, more than a period
PAIRS = 5


def silent(*_: object) -> None:
    """No progress is told."""


def fall(granulate: Granulate, numerics: PouringNumerics) -> None:
    for _ in range(FALLING_STEPS):
        granulate.advance(numerics)


def shake(granulate: Granulate, numerics: PouringNumerics) -> None:
    paper = Vibration()
    pressure = granulate.weight() / (granulate.plane_point[3, 0] * granulate.plane_point[4, 1])
    shaking = Shaking(paper.stroke, paper.frequency, VIBRATED, pressure)
    vibrate(granulate, numerics, shaking, Course(), silent)


def measured(granulate: Granulate, numerics: PouringNumerics, work, threads: int) -> tuple[float, bytes]:
    """Wall time [s] of the same work from the same state, and what came of it."""
    copy = deepcopy(granulate)
    copy._room = None  # rows of a copy do not begin at cache lines, as those of a pouring do
    copy._list(copy._start, copy._other)
    with Team(threads) as copy.team:
        copy.advance(numerics)
        began = time.perf_counter()
        work(copy, numerics)
        return time.perf_counter() - began, copy.position.tobytes() + copy.impulse.tobytes()


def compared(
    name: str, granulate: Granulate, numerics: PouringNumerics, work, threads: int
) -> dict[str, object]:
    """A row: how many times faster so many threads are."""
    ratios, walls = [], []
    for _ in range(PAIRS):
        one, single = measured(granulate, numerics, work, 1)
        more, several = measured(granulate, numerics, work, threads)
        if single != several:
            raise ArithmeticError(f"{name}: one thread and {threads} give different numbers")
        ratios.append(one / more)
        walls.append(one)
    return {
        "work": name,
        "spheres": granulate.radius.size,
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
    granulate = Granulate.in_box(position, radius, box, DENSITY, FRICTION)
    granulate.let_fall()
    with Team(told.threads) as team:
        granulate.team = team
        while granulate.time < FALL:
            granulate.advance(numerics)
        granulate.team = Team()
        falling = deepcopy(granulate)
        granulate.team = team
        settle(granulate, numerics, REST_SPEED, LONGEST_POURING, silent, "")
        granulate.team = Team()
    rows = [
        compared("falling", falling, numerics, fall, told.threads),
        compared("vibrating", granulate, numerics, shake, told.threads),
    ]
    write_table(told.output, pd.DataFrame(rows))


if __name__ == "__main__":
    main()
