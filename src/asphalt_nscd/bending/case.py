"""What a test is: what the head does, how the answer is computed, what a run tells and keeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.bending.settings import MOST_STEPS, Load, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.measurements.shape import Shape
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
        """Displacement z (s,) [m] of the actuator at the times (s,) [s]; its force [N] where that is commanded."""
        return self.amplitude * np.sin(self.omega * time)

    def recorded(self, time: Vector) -> Vector:
        """Displacement (s,) [m] that the channel records at `time` (s,) [s], late by its delay and its phase offset."""
        angle = self.omega * (time - self.rig.channel_delay) - self.rig.phase_offset
        # at rest until the motion arrives at the channel
        return np.where(angle > 0.0, self.amplitude * np.sin(angle), 0.0)

    def steps(self, numerics: Numerics) -> int:
        """Number of steps of `numerics.time_step` while the head moves."""
        # infinity cannot be rounded; 1e18 steps are refused in a sentence
        return round(min(self.cycles / self.frequency / numerics.time_step, 1e18))

    def times(self, numerics: Numerics) -> Vector:
        """Ends (s,) of the steps while the head moves [s].

        >>> LoadCase(frequency=100.0, cycles=0.3).times(Numerics(time_step=1e-3)).round(6).tolist()
        [0.001, 0.002, 0.003]
        """
        return numerics.time_step * np.arange(1.0, self.steps(numerics) + 1.0)

    def framed(self, numerics: Numerics, count: int) -> NDArray[np.int64]:
        """Places (f,) in `times` of the steps to keep: `count`, evenly over the last cycle, its end included."""
        times = self.times(numerics)
        # the instant a whole cycle before the end is the end again: left out, however it rounds
        last = np.flatnonzero(times > times[-1] - (1.0 - 1e-9) / self.frequency)
        # each once, where more frames are wanted than the cycle has steps
        return np.unique(last[-1] - np.round(np.arange(count) * last.size / max(count, 1)).astype(int))

    def driven(self, numerics: Numerics) -> Vector:
        """Displacement (rest_steps + s,) [m] of the actuator in every step, those at rest included."""
        return np.concatenate([np.zeros(numerics.rest_steps), self.actuator(self.times(numerics))])


def load_case(load: Load, frequency_Hz: float, shape: Shape) -> LoadCase:
    """The case of one frequency on specimens of a geometry, whose usual amplitude is taken where none is given.

    >>> from asphalt_nscd.measurements.twopoint import PAPER
    >>> print(f"{load_case(Load(frames=24), 10.0, PAPER).amplitude:.2g} m")
    6.3e-05 m
    """
    if not Range(above=0.0).holds(frequency_Hz):
        raise InputError(f"frequency_Hz = {frequency_Hz:g}: give a frequency greater than zero.")
    if load.amplitude_N is not None:
        if load.amplitude_m is not None:
            raise InputError("load: give amplitude_m or amplitude_N, that of what is commanded.")
        return LoadCase(frequency_Hz, load.amplitude_N, load.cycles, load.rig, by_force=True)
    amplitude_m = shape.usual_amplitude() if load.amplitude_m is None else load.amplitude_m
    return LoadCase(frequency_Hz, amplitude_m, load.cycles, load.rig)


@dataclass(frozen=True)
class RunOptions:
    """What a run tells and keeps.

    `progress` is called with (steps done, steps in all); `most_broken` and `most_closed` are the shares of bonds broken
    and of gaps closed at once beyond which the run ends with a message. `energy` keeps the energy account of a reduced
    run too; `frames` instants of the last cycle are kept with all spheres and bonds. Either makes the steps one by one.
    A run that cannot go on raises, or ends with the record so far (`keeps_record`). `to_failure`: it goes on in pieces,
    however many bonds break.
    """

    progress: Progress = lambda done, total: None
    energy: bool = False
    frames: int = 0
    most_broken: float = 0.2  # beyond, bond after bond breaks, and each is solved for: it took minutes
    most_closed: float = 0.1
    keeps_record: bool = False
    to_failure: bool = False


def require_possible(case: LoadCase, numerics: Numerics, options: RunOptions) -> None:
    """Refuse too many steps, and a rig, scheme or frames that the method cannot do."""
    method, scheme, count = numerics.method, numerics.scheme, case.steps(numerics) + numerics.rest_steps
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
    if options.energy and (case.by_force or not steps):
        raise InputError(
            "energy: of a commanded force, and by the methods sweeps and harmonic, no account is kept; leave it out."
        )
    if options.frames and not steps:
        raise InputError(f"method {method} keeps no frames; choose the method reduced or condensed.")
    if method == "sweeps" and not case.rig.is_rigid:
        raise InputError(
            "rig: the method sweeps cannot simulate devices at the head; choose the method reduced."
        )
