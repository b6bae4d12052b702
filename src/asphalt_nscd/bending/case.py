"""What a test is: what the head does, how the answer is computed, what a run tells and keeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.checkpoint import Checkpoint
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.files.errors import InputError

Vector = NDArray[np.float64]
Progress = Callable[[int, int], None]
"""Called with (steps done, steps in all)."""

METHODS = ("reduced", "condensed", "sweeps", "harmonic")


@dataclass(frozen=True)
class LoadCase:
    """The actuator follows z = A sin(2 pi f t) from t = 0; the rig stands between it, the head and the record."""

    frequency: float  # f, Hz
    amplitude: float = 63e-6  # A, m
    cycles: float = 5.0
    rig: Rig = Rig()

    @property
    def omega(self) -> float:
        """2 pi f [rad/s]."""
        return 2.0 * np.pi * self.frequency

    def actuator(self, time: Vector) -> Vector:
        """Displacement z (s,) [m] of the actuator at the times (s,) [s]."""
        return self.amplitude * np.sin(self.omega * time)

    def recorded(self, time: Vector) -> Vector:
        """The same as the measuring channel records it: late by its delay and its phase offset."""
        angle = self.omega * (time - self.rig.channel_delay) - self.rig.phase_offset
        return np.where(angle > 0.0, self.amplitude * np.sin(angle), 0.0)


@dataclass(frozen=True)
class Numerics:
    """How a test is computed.

    method: one of METHODS; "harmonic" gives the steady oscillation of the unbroken system, without gravity or
    transient. scheme: one of nscd.stepping.scheme.SCHEMES, for "reduced" and "condensed". tolerance and
    most_sweeps stop the Gauss-Seidel iterations of "sweeps".
    """

    time_step: float = 5e-5  # s
    rest_steps: int = 1000  # under gravity, before the head moves
    method: str = "reduced"
    scheme: str = "euler"
    tolerance: float = 1e-4  # relative change in a sweep
    most_sweeps: int = 50  # in a step

    def times(self, case: LoadCase) -> Vector:
        """Ends of the steps (s,) [s] while the head moves."""
        steps = round(case.cycles / case.frequency / self.time_step)
        return self.time_step * np.arange(1.0, steps + 1.0)

    def driven(self, case: LoadCase) -> Vector:
        """Displacement of the actuator [m] in every step, those at rest included."""
        return np.concatenate([np.zeros(self.rest_steps), case.actuator(self.times(case))])


@dataclass(frozen=True)
class RunOptions:
    """What a run tells and keeps.

    energy: keep the energy account of a reduced run too; it then makes its steps one by one. checkpoint: where the
    run is kept, and from where it goes on; "reduced" and "condensed".
    """

    progress: Progress = lambda done, total: None
    energy: bool = False
    checkpoint: Checkpoint | None = None


def require_possible(case: LoadCase, numerics: Numerics, options: RunOptions) -> None:
    """InputError where a method cannot do what is asked of it."""
    method, scheme = numerics.method, numerics.scheme
    steps = method in ("reduced", "condensed")
    if method == "harmonic" and case.rig.guide_friction:
        raise InputError("rig: a slider has no steady harmonic oscillation; choose the method reduced.")
    if scheme != "euler" and not steps:
        raise InputError(f"method {method} has no scheme {scheme!r}; choose the method reduced or condensed.")
    if options.checkpoint is not None and not steps:
        raise InputError(f"method {method} keeps no checkpoint; choose the method reduced or condensed.")
    if method == "sweeps" and not case.rig.is_rigid:
        raise InputError("rig: the method sweeps has no devices at the head; choose the method reduced.")
