"""Pouring by gravity and vibrating with the top wall (section 3.2.1 of the paper)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from asphalt_nscd.specimen.granular_bed import WALL, GranularBed, PouringNumerics
from asphalt_nscd.specimen.settings import Vibration

REST_SPEED = 1e-3  # m/s, root mean square of all spheres
REST_TOLERANCE = 1e-5  # of the sweeps that bring a layer into equilibrium, which is judged to UNBALANCED
REST_SWEEPS = 300
UNBALANCED = 5e-4  # half of what the table of the preparation asks for
RECORD = 5e-3  # s, between two points of the curve of the height
WALL_MASS = 0.01  # of the layer

Progress = Callable[[str, float, float], None]
"""Called with (stage, done, total), both in the unit of the stage."""


@dataclass
class PouringHistory:
    """What happened to a layer, point by point in time and period by period."""

    time: list[float] = field(default_factory=list)  # s
    height: list[float] = field(default_factory=list)  # m
    wall: list[float] = field(default_factory=list)  # m, NaN where it is out of the way
    touched: list[int] = field(default_factory=list)  # grains touched by the wall in each period

    def note(self, bed: GranularBed, wall: float = np.nan) -> None:
        """Add the time [s] and layer height [m] of the bed, and the top `wall` [m], NaN while it is out of the way."""
        self.time.append(bed.time)
        self.height.append(bed.layer_height())
        self.wall.append(wall)

    def arrays(self) -> dict[str, np.ndarray]:
        """What is written of the history, by name in the file."""
        return {
            "course/time": np.array(self.time),
            "course/height": np.array(self.height),
            "course/wall": np.array(self.wall),
            "course/touched": np.array(self.touched, int),
        }


def settle(
    bed: GranularBed,
    numerics: PouringNumerics,
    rest_speed: float,
    longest: float,
    progress: Progress,
    stage: str,
) -> None:
    """Advance the bed in place until its root mean square speed stays under `rest_speed` [m/s].

    It must do so at four looks in a row, 5 ms apart, or `longest` [s] ends it; `progress` is in seconds of the bed.
    """
    n = bed.radius.size
    began = bed.time
    check = max(1, round(5e-3 / numerics.time_step))
    calm = 0
    while bed.time - began < longest and calm < 4:
        for _ in range(check):
            bed.advance(numerics)
        rms = float(np.sqrt((bed.velocity[:n, :3] ** 2).sum(axis=1).mean()))
        calm = calm + 1 if rms < rest_speed else 0
        progress(stage, min(bed.time - began, longest), longest)


def balance(
    bed: GranularBed, numerics: PouringNumerics, longest: float, progress: Progress, stage: str
) -> tuple[float, float]:
    """Advance the bed in place with tight sweeps until forces are in equilibrium, at most `longest` [s].

    Sweeps follow REST_TOLERANCE and REST_SWEEPS; `progress` is in seconds of the bed. Returns the two of
    `GranularBed.imbalance`, below UNBALANCED unless `longest` ended it.
    """
    tight = replace(numerics, tolerance=REST_TOLERANCE, most_sweeps=REST_SWEEPS)
    began = bed.time
    check = max(1, round(5e-3 / numerics.time_step))
    found = np.inf, np.inf
    while bed.time - began < longest and max(found) > UNBALANCED:
        for _ in range(check):
            bed.advance(tight)
        found = bed.imbalance(tight.time_step)
        progress(stage, min(bed.time - began, longest), longest)
    return found


def vibrate(
    bed: GranularBed,
    numerics: PouringNumerics,
    vibration: Vibration,
    pressure: float,
    history: PouringHistory,
    progress: Progress,
) -> None:
    """Drive the top wall by stroke/2 cos(2 pi f t) about the top of the layer, found anew in each period.

    The lower half of the stroke would pass through rigid grains once they lie dense. So the wall is a light plate
    between rails: its drive pushes with at most `pressure` [Pa] over the area of the box. The bed changes in place; its
    wall hangs clear of the grains in the end. `history` takes heights each 5 ms and, per period, how many grains the
    wall touched.
    """
    # only what falls may overlap more for a moment: what the wall presses together stays in the layer
    numerics = replace(
        numerics, falling_sweeps=numerics.most_sweeps, falling_penetration=numerics.penetration
    )
    n, dt = bed.radius.size, numerics.time_step
    omega = 2.0 * np.pi * vibration.frequency
    length, width = bed.plane_point[3, 0], bed.plane_point[4, 1]
    push = pressure * length * width * dt
    steps, every, touched = round(vibration.duration / dt), max(1, round(RECORD / dt)), np.zeros(n, bool)
    mass = WALL_MASS * bed.weight() / float(np.linalg.norm(bed.gravity))
    # where the stroke begins, half of it above the grains
    bed.hang_wall(bed.top() + vibration.stroke / 2.0, mass)
    for k in range(steps):
        # 1e-9: the product of a whole period may round to less than a whole number
        if int(k * dt * vibration.frequency + 1e-9) == len(history.touched):  # a period begins
            # found anew: about a fixed level the wall touched grains in the first three periods of thirty
            level = bed.top()
            history.touched.append(0)
            touched[:] = False
        height = level + vibration.stroke / 2.0 * np.cos(omega * (k + 1) * dt)
        bed.drive[:] = (height - bed.plane_point[WALL, 2]) / dt, push
        bed.advance(numerics)
        touched[bed.touching_wall()] = True
        history.touched[-1] = int(touched.sum())
        if k % every == every - 1:
            history.note(bed, bed.plane_point[WALL, 2])
            progress("vibrating", k + 1, steps)
    # out of the way of the grains, which come to rest without it
    bed.fix_wall(bed.top() + vibration.stroke / 2.0)
