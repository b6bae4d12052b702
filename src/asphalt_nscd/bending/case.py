"""What a test is: what the head does, how the answer is computed, what a run tells and keeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.bending.settings import MOST_STEPS, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import PAPER_AMPLITUDE

Vector = NDArray[np.float64]
Progress = Callable[[int, int], None]
"""Called with (steps done, steps in all)."""


@dataclass(frozen=True)
class LoadCase:
    """The actuator follows A sin(2 pi f t) from t = 0; the rig stands between it, the head and the record.

    `frequency` f in Hz; `amplitude` A in m, or in N where `by_force`: the force is then commanded and the displacement
    measured. The last two of `cycles` give E*. `rig` holds the devices at the head and the errors of the channel.
    """

    frequency: float
    amplitude: float = PAPER_AMPLITUDE
    cycles: float = 5.0
    rig: Rig = Rig()
    by_force: bool = False

    @property
    def omega(self) -> float:
        """Angular frequency 2 pi f [rad/s]."""
        return 2.0 * np.pi * self.frequency

    def actuator(self, time: Vector) -> Vector:
        """Displacement z (s,) of the actuator at the times (s,) in s [m]."""
        return self.amplitude * np.sin(self.omega * time)

    def recorded(self, time: Vector) -> Vector:
        """Displacement (s,) that the channel records, late by its delay and its phase offset; `time` (s,) in s [m]."""
        angle = self.omega * (time - self.rig.channel_delay) - self.rig.phase_offset
        # at rest until the motion arrives at the channel
        return np.where(angle > 0.0, self.amplitude * np.sin(angle), 0.0)


@dataclass(frozen=True)
class RunOptions:
    """What a run tells and keeps.

    `progress` is called with (steps done, steps in all); `most_broken` and `most_closed` are the shares of bonds broken
    and of gaps closed at once beyond which the run ends with a message. `energy` keeps the energy account of a reduced
    run too; `frames` instants of the last cycle are kept with all spheres and bonds. Either makes the steps one by one.
    """

    progress: Progress = lambda done, total: None
    energy: bool = False
    frames: int = 0
    most_broken: float = 1.0
    most_closed: float = 0.1


def require_possible(case: LoadCase, numerics: Numerics, options: RunOptions) -> None:
    """Refuse too many steps, and a rig, scheme or frames that the method cannot do."""
    method, scheme, count = numerics.method, numerics.scheme, numerics.steps(case) + numerics.rest_steps
    if count > MOST_STEPS:
        raise InputError(
            f"{count:.3g} steps of {numerics.time_step:g} s; a test takes at most {MOST_STEPS:g}: raise the time step "
            "or give fewer cycles."
        )
    steps = method in ("reduced", "condensed")
    if case.by_force and (case.rig != Rig() or method == "sweeps"):
        raise InputError(
            "load: a commanded force goes without devices and errors of a rig, and not by the method sweeps; leave "
            "the rig out, or give amplitude_m."
        )
    if method == "harmonic" and case.rig.guide_friction:
        raise InputError(
            "rig: with guide friction the oscillation is not harmonic; choose the method reduced."
        )
    if scheme != "euler" and not steps:
        raise InputError(f"method {method} has no scheme {scheme!r}; choose the method reduced or condensed.")
    if options.frames and not steps:
        raise InputError(f"method {method} keeps no frames; choose the method reduced or condensed.")
    if method == "sweeps" and not case.rig.is_rigid:
        raise InputError(
            "rig: the method sweeps cannot simulate devices at the head; choose the method reduced."
        )
