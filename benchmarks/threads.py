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
from growth import BOX
from rows import Clock, write_rows

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
    with Team(threads) as copy.team:
        copy.advance(numerics)
        began = time.perf_counter()
        work(copy, numerics)
        return time.perf_counter() - began, copy.position.tobytes() + copy.impulse.tobytes()


def compared(
    name: str, granulate: Granulate, numerics: PouringNumerics, work, threads: int
) -> dict[str, object]:
    """A row: how many times faster so many threads are."""
    clock, ratios, walls = Clock(), [], []
    for _ in range(PAIRS):
        one, single = measured(granulate, numerics, work, 1)
        more, several = measured(granulate, numerics, work, threads)
        if single != several:
            raise ArithmeticError(f"{name}: one thread and {threads} give different numbers")
        ratios.append(one / more)
        walls.append(one)
    remark = (
        f"{np.median(ratios):.2f} times as fast as one thread, {min(ratios):.2f} to {max(ratios):.2f} in {PAIRS} pairs "
        f"of runs; one thread {np.median(walls):.2f} s; equal bits"
    )
    return {"case": f"{name}, {threads} threads", "remark": remark} | clock.row()


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
    same = {"topic": "threads", "spheres": radius.size, "time_step_s": numerics.time_step}
    write_rows(told.output, [same | row for row in rows])


if __name__ == "__main__":
    main()
