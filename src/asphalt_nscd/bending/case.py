"""What a test is: what the head does, how the answer is computed, what a run tells and keeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.bending.checkpoint import Checkpoint
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range, Ranged, one_of, within
from asphalt_nscd.measurements.kinds import usual_steps_per_cycle
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.twopoint import PAPER_AMPLITUDE
from asphalt_nscd.nscd.stepping.scheme import SCHEMES

Vector = NDArray[np.float64]
Progress = Callable[[int, int], None]
"""Called with (steps done, steps in all)."""

METHODS = ("reduced", "condensed", "sweeps", "harmonic")
MOST_STEPS = 5_000_000  # of a test, which keeps some 200 bytes of each


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
class Numerics(Ranged):
    """How a test is computed.

    Parameters
    ----------
    time_step : float
        Of implicit steps [s].
    rest_steps : int
        Under gravity, before the head moves.
    method : str
        "reduced", "condensed", "sweeps", or "harmonic", which gives the steady oscillation of the unbroken
        system, without gravity or transient.
    scheme : str
        One of `nscd.stepping.scheme.SCHEMES`, for "reduced" and "condensed".
    tolerance : float
        Relative change in a sweep that ends the Gauss-Seidel iterations of "sweeps".
    most_sweeps : int
        In a step of "sweeps".

    Examples
    --------
    >>> Numerics(time_step=1e-3).times(LoadCase(frequency=100.0, cycles=0.3)).round(6).tolist()
    [0.001, 0.002, 0.003]
    """

    # at 15 degC and 3 Hz solved steps from 2e-5 to 2e-4 s give one |E*| within 0.03 % (docs/results.md)
    time_step: float = within(5e-5, "time_step_s", above=0.0)
    rest_steps: int = within(1000, low=0, high=MOST_STEPS)
    method: str = one_of("reduced", METHODS)
    scheme: str = one_of("euler", SCHEMES)
    tolerance: float = within(1e-4, low=0.0)
    most_sweeps: int = within(50, low=1, high=100_000)

    @classmethod
    def usual(cls, frequency_Hz: float, shape: Shape) -> Numerics:
        """The paper's steps for the paper's test; for others `usual_steps_per_cycle` by the scheme fitted to it.

        Parameters
        ----------
        frequency_Hz : float
            Of the actuator [Hz].
        shape : Shape
            Geometry, which says the test.

        Returns
        -------
        Numerics
            Of the method "reduced".
        """
        steps = usual_steps_per_cycle(shape.test)
        return cls(1.0 / (frequency_Hz * steps), scheme="fitted") if steps else cls()

    def steps(self, case: LoadCase) -> int:
        """Number of steps while the head moves.

        Parameters
        ----------
        case : LoadCase
            Frequency and cycles.

        Returns
        -------
        int
            Steps of `time_step`.
        """
        # infinity cannot be rounded; 1e18 steps are refused in a sentence
        return round(min(case.cycles / case.frequency / self.time_step, 1e18))

    def times(self, case: LoadCase) -> Vector:
        """Ends of the steps while the head moves.

        Parameters
        ----------
        case : LoadCase
            Frequency and cycles.

        Returns
        -------
        ndarray (s,)
            Times [s].
        """
        return self.time_step * np.arange(1.0, self.steps(case) + 1.0)

    def framed(self, case: LoadCase, count: int) -> NDArray[np.int64]:
        """The steps to keep, evenly over the last cycle, its end included.

        Parameters
        ----------
        case : LoadCase
            Frequency and cycles.
        count : int
            How many instants.

        Returns
        -------
        ndarray of int (f,)
            Places in `times`.
        """
        times = self.times(case)
        # the instant a whole cycle before the end is the end again: left out, however it rounds
        last = np.flatnonzero(times > times[-1] - (1.0 - 1e-9) / case.frequency)
        # each once, where more frames are wanted than the cycle has steps
        return np.unique(last[-1] - np.round(np.arange(count) * last.size / max(count, 1)).astype(int))

    def driven(self, case: LoadCase) -> Vector:
        """Displacement of the actuator in every step, those at rest included.

        Parameters
        ----------
        case : LoadCase
            Frequency, amplitude and cycles.

        Returns
        -------
        ndarray (rest_steps + s,)
            [m].
        """
        return np.concatenate([np.zeros(self.rest_steps), case.actuator(self.times(case))])


@dataclass(frozen=True)
class RunOptions:
    """What a run tells and keeps.

    `progress` is called with (steps done, steps in all); `most_broken` and `most_closed` are the shares of bonds broken
    and of gaps closed at once beyond which the run ends with a message. `energy` keeps the energy account of a reduced
    run too; `frames` instants of the last cycle are kept with all spheres and bonds. Either makes the steps one by one.
    A `checkpoint`, from which a run goes on, is for "reduced" and "condensed".
    """

    progress: Progress = lambda done, total: None
    energy: bool = False
    checkpoint: Checkpoint | None = None
    frames: int = 0
    most_broken: float = 0.2  # beyond, bond after bond breaks, and each is solved for: it took minutes
    most_closed: float = 0.1


@dataclass(frozen=True)
class Load(Ranged):
    """What the actuator does, what stands between it, the head and the record, and what is kept of it.

    Parameters
    ----------
    amplitude_m : float, optional
        Of the head [m]. Without it the strain is usual: in bending that of the paper's 63 um on its own
        specimen, in tension-compression 50e-6.
    cycles : float
        How many; the last two give E*.
    rig : Rig
        Devices at the head, and errors of the measuring channel.
    frames : int
        How many instants of the last cycle to keep with the motion of all spheres and the forces of all
        bonds, for a series of ParaView.
    amplitude_N : float, optional
        Of the force [N], which is then commanded.

    Examples
    --------
    >>> from asphalt_nscd.measurements.twopoint import PAPER
    >>> print(f"{Load(frames=24).at(10.0, PAPER).amplitude:.2g} m")
    6.3e-05 m
    """

    amplitude_m: float | None = within(None, low=1e-15, high=1.0)
    cycles: float = within(5.0, low=1.0)
    rig: Rig = Rig()
    frames: int = within(0, low=0, high=10_000)
    amplitude_N: float | None = within(None, low=1e-9, high=1e9)

    def at(self, frequency_Hz: float, shape: Shape) -> LoadCase:
        """The case of one frequency on specimens of a geometry.

        Parameters
        ----------
        frequency_Hz : float
            Of the actuator [Hz].
        shape : Shape
            Geometry, whose usual amplitude is taken where none is given.

        Returns
        -------
        LoadCase
            What the actuator does.

        Raises
        ------
        InputError
            For a frequency that is not greater than zero, or both amplitudes.
        """
        if not Range(above=0.0).holds(frequency_Hz):
            raise InputError(f"frequency_Hz = {frequency_Hz:g}: give a frequency greater than zero.")
        if self.amplitude_N is not None:
            if self.amplitude_m is not None:
                raise InputError("load: give amplitude_m or amplitude_N, that of what is commanded.")
            return LoadCase(frequency_Hz, self.amplitude_N, self.cycles, self.rig, by_force=True)
        amplitude_m = shape.usual_amplitude() if self.amplitude_m is None else self.amplitude_m
        return LoadCase(frequency_Hz, amplitude_m, self.cycles, self.rig)


def require_possible(case: LoadCase, numerics: Numerics, options: RunOptions) -> None:
    """Refuse too many steps, and a rig, scheme, checkpoint or frames that the method cannot do."""
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
    if options.checkpoint is not None and not steps:
        raise InputError(f"method {method} keeps no checkpoint; choose the method reduced or condensed.")
    if options.frames and (not steps or options.checkpoint is not None):
        raise InputError(
            "frames: kept of the methods reduced and condensed, without a checkpoint; leave one out."
        )
    if method == "sweeps" and not case.rig.is_rigid:
        raise InputError(
            "rig: the method sweeps cannot simulate devices at the head; choose the method reduced."
        )
