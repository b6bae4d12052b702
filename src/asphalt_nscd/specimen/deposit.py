"""Pouring by gravity and vibrating with the top wall (section 3.2.1 of the paper)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from asphalt_nscd.specimen.granulate import WALL, Granulate, PouringNumerics

REST_SPEED = 1e-3  # m/s, root mean square of all spheres
REST_TOLERANCE = 1e-5  # of the sweeps that bring a layer into equilibrium
REST_SWEEPS = 300
UNBALANCED = 5e-4  # half of what the table of the preparation asks for
RECORD = 5e-3  # s, between two points of the curve of the height
WALL_MASS = 0.01  # of the layer

Progress = Callable[[str, float, float], None]
"""Called with (stage, done, total), both in the unit of the stage."""


@dataclass(frozen=True)
class Shaking:
    """The drive of the top wall."""

    stroke: float  # m, crest to crest
    frequency: float  # Hz
    duration: float  # s
    pressure: float  # Pa, with which the wall pushes at most


@dataclass
class Course:
    """What happened to a layer, point by point in time and period by period."""

    time: list[float] = field(default_factory=list)  # s
    height: list[float] = field(default_factory=list)  # m
    wall: list[float] = field(default_factory=list)  # m, NaN where it is out of the way
    touched: list[int] = field(default_factory=list)  # grains touched by the wall in each period

    def note(self, granulate: Granulate, wall: float = np.nan) -> None:
        self.time.append(granulate.time)
        self.height.append(granulate.layer_height())
        self.wall.append(wall)

    def arrays(self) -> dict[str, np.ndarray]:
        return {
            "course/time": np.array(self.time),
            "course/height": np.array(self.height),
            "course/wall": np.array(self.wall),
            "course/touched": np.array(self.touched, int),
        }


def settle(
    granulate: Granulate,
    numerics: PouringNumerics,
    rest_speed: float,
    longest: float,
    progress: Progress,
    stage: str,
) -> None:
    """Advance until the root mean square speed stays under rest_speed [m/s], at most `longest` [s]."""
    n = granulate.radius.size
    began = granulate.time
    check = max(1, round(5e-3 / numerics.time_step))
    calm = 0
    while granulate.time - began < longest and calm < 4:
        for _ in range(check):
            granulate.advance(numerics)
        rms = float(np.sqrt((granulate.velocity[:n, :3] ** 2).sum(axis=1).mean()))
        calm = calm + 1 if rms < rest_speed else 0
        progress(stage, min(granulate.time - began, longest), longest)


def balance(
    granulate: Granulate, numerics: PouringNumerics, longest: float, progress: Progress, stage: str
) -> tuple[float, float]:
    """Advance with tight sweeps until forces are in equilibrium, at most `longest` [s]; see out_of_balance."""
    tight = replace(numerics, tolerance=REST_TOLERANCE, most_sweeps=REST_SWEEPS)
    began = granulate.time
    check = max(1, round(5e-3 / numerics.time_step))
    found = np.inf, np.inf
    while granulate.time - began < longest and max(found) > UNBALANCED:
        for _ in range(check):
            granulate.advance(tight)
        found = granulate.out_of_balance(tight.time_step)
        progress(stage, min(granulate.time - began, longest), longest)
    return found


def vibrate(
    granulate: Granulate, numerics: PouringNumerics, shaking: Shaking, course: Course, progress: Progress
) -> None:
    """Drive the top wall by stroke/2 cos(2 pi f t) about the top of the layer, found anew in each period.

    The lower half of the stroke would pass through rigid grains once they lie dense. So the wall is a light
    plate between rails: its drive pushes with a pressure of at most `shaking.pressure`.
    """
    numerics = replace(
        numerics, falling_sweeps=numerics.most_sweeps, falling_penetration=numerics.penetration
    )
    n, dt = granulate.radius.size, numerics.time_step
    omega = 2.0 * np.pi * shaking.frequency
    length, width = granulate.plane_point[3, 0], granulate.plane_point[4, 1]
    push = shaking.pressure * length * width * dt
    steps, every, touched = round(shaking.duration / dt), max(1, round(RECORD / dt)), np.zeros(n, bool)
    mass = WALL_MASS * granulate.weight() / float(np.linalg.norm(granulate.gravity))
    granulate.hang_wall(granulate.top() + shaking.stroke / 2.0, mass)
    for k in range(steps):
        if int(k * dt * shaking.frequency + 1e-9) == len(course.touched):  # a period begins
            level = granulate.top()
            course.touched.append(0)
            touched[:] = False
        height = level + shaking.stroke / 2.0 * np.cos(omega * (k + 1) * dt)
        granulate.drive[:] = (height - granulate.plane_point[WALL, 2]) / dt, push
        granulate.advance(numerics)
        touched[granulate.touching_wall()] = True
        course.touched[-1] = int(touched.sum())
        if k % every == every - 1:
            course.note(granulate, granulate.plane_point[WALL, 2])
            progress("vibrating", k + 1, steps)
    granulate.fix_wall(granulate.top() + shaking.stroke / 2.0)
