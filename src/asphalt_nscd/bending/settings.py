"""What a user sets of a test on a specimen. No numpy, for command line and schema ask it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.options import Ranged, option
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.measurements.kinds import usual_steps_per_cycle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from asphalt_nscd.bending.case import LoadCase, Vector
    from asphalt_nscd.measurements.shape import Shape

# blocked, |E*| of the paper's specimen is 2.6 times that of its law, free 1.1 (bond_readings.csv)
HEADS = ("free", "blocked")
METHODS = ("reduced", "condensed", "sweeps", "harmonic")
SCHEMES = ("euler", "fitted")
MOST_STEPS = 5_000_000  # of a test, which keeps some 200 bytes of each
MOST_STEPS_OF_FALL = 1_000_000  # of some milliseconds each
MILLION = 1e6  # cycles, to which epsilon6 refers
STRAINS = Range(low=1e-8, high=0.1)


@dataclass(frozen=True)
class Bonds(Ranged):
    """What bonds are beside their law, and whether the head rotates.

    Parameters
    ----------
    head : str
        "free" or "blocked".
    poisson : float
        nu of Eqs. (8)-(11), for bonds by area "paper".
    kt_over_kn : float
        Tangential over normal stiffness, for bonds by area "facets".
    yield_Pa : float
        Stress at which a bond breaks [Pa].
    friction : float
        Where the gap of a broken bond closes.

    Examples
    --------
    >>> Bonds(head="blocked", yield_Pa=5e6).kt_over_kn
    1.0
    """

    head: str = option(
        "Rotation of the driven head, free as the form factor assumes, or blocked.", "free", choices=HEADS
    )
    # a network then shows 0.16
    poisson: float = option(
        "Poisson's ratio in Eqs. (8)-(11), which give a bond's tangential stiffness from its normal one. Used with "
        "area paper.",
        0.35,
        above=-1.0,
        high=0.5,
    )
    # one is the modulus of the law (facet_network)
    kt_over_kn: float = option(
        "Tangential over normal stiffness of a bond. Used with area facets; with 1 a uniform strain is exact in any "
        "packing.",
        1.0,
        low=1e-4,
        high=10.0,
    )
    # the paper's, which names no test behind it
    yield_Pa: float = option("Stress at which a bond between two spheres breaks, Pa.", 2.7e6, low=1.0)
    friction: float = option(
        "Coefficient of friction where a bond is broken or a gap closes.", 0.7, low=0.0, high=100.0
    )


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
        One of `SCHEMES`, for "reduced" and "condensed".
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
    time_step: float = option(
        "Time step, s. Other tests than two-point bending take 200 steps per cycle unless it is given.",
        5e-5,
        key="time_step_s",
        above=0.0,
    )
    rest_steps: int = option(
        "Time steps at rest under gravity before the test.", 1000, low=0, high=MOST_STEPS
    )
    method: str = option(
        "Reduced form, full condensed system, plain Gauss-Seidel on the bonds, or steady oscillation.",
        "reduced",
        choices=METHODS,
    )
    scheme: str = option(
        "Implicit Euler, or BDF2 fitted to the frequency: exact in steady oscillation, 100 steps a cycle do.",
        "euler",
        choices=SCHEMES,
    )
    tolerance: float = option("Relative change per sweep that stops Gauss-Seidel.", 1e-4, low=0.0)
    most_sweeps: int = option("Largest number of Gauss-Seidel sweeps in a step.", 50, low=1, high=100_000)

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
        import numpy as np

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
        import numpy as np

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
        import numpy as np

        return np.concatenate([np.zeros(self.rest_steps), case.actuator(self.times(case))])


@dataclass(frozen=True)
class Fitted(Ranged):
    """Time steps that are a share of a cycle, in place of `Numerics.time_step` and `Numerics.scheme`."""

    steps_per_cycle: int | None = option(
        "Time steps in a cycle of each frequency, by a scheme fitted to it, in place of time_step_s; 200 leave less "
        "than 0.01 degrees. Without either, two-point bending takes implicit Euler, as in the paper, and other tests "
        "200.",
        None,
        low=20,
    )


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

    amplitude_m: float | None = option(
        "Amplitude of the head's displacement, m. Default is the paper's 63e-6 in two-point bending, and what strains "
        "other specimens by 50e-6.",
        None,
        low=1e-15,
        high=1.0,
    )
    cycles: float = option("Number of cycles, starting from rest.", 5.0, low=1.0)
    rig: Rig = Rig()
    frames: int = option(
        "Instants of the last cycle of which to keep the motion of all spheres and the forces of all bonds; 24 bytes a "
        "sphere and 12 a bond each, before they are packed.",
        0,
        low=0,
        high=10_000,
    )
    amplitude_N: float | None = option(
        "Amplitude of the force, N: it is commanded, the displacement measured, and the weight tared.",
        None,
        low=1e-9,
        high=1e9,
    )

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
        from asphalt_nscd.bending.case import LoadCase

        if not Range(above=0.0).holds(frequency_Hz):
            raise InputError(f"frequency_Hz = {frequency_Hz:g}: give a frequency greater than zero.")
        if self.amplitude_N is not None:
            if self.amplitude_m is not None:
                raise InputError("load: give amplitude_m or amplitude_N, that of what is commanded.")
            return LoadCase(frequency_Hz, self.amplitude_N, self.cycles, self.rig, by_force=True)
        amplitude_m = shape.usual_amplitude() if self.amplitude_m is None else self.amplitude_m
        return LoadCase(frequency_Hz, amplitude_m, self.cycles, self.rig)


@dataclass(frozen=True)
class Hold(Ranged):
    """What is held, for how long, in how many equal steps.

    Parameters
    ----------
    duration_s : float
        Of the test [s].
    steps : int
        Of equal length.
    force_N : float, optional
        Held on the head [N]: creep.
    displacement_m : float, optional
        Held at the head [m]: relaxation. Without either it is relaxation too, at the amplitude of usual
        tests.

    Raises
    ------
    InputError
        For force and displacement together, or a zero held.

    Examples
    --------
    >>> Hold(duration_s=10.0, steps=500, force_N=300.0).time_step
    0.02
    """

    duration_s: float = option("How long, s.", 10.0, low=1e-6, high=1e9)
    steps: int = option("Equal time steps; errors fall with their length.", 1000, low=10, high=MOST_STEPS)
    force_N: float | None = option("Force held, N: creep.", None, low=-1e9, high=1e9)
    displacement_m: float | None = option(
        "Displacement of the head held, m: relaxation. The default, at the amplitude of usual tests.",
        None,
        low=-1.0,
        high=1.0,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.force_N is not None and self.displacement_m is not None:
            raise InputError("hold: give force_N for creep or displacement_m for relaxation, not both.")
        if 0.0 in (self.force_N, self.displacement_m):
            raise InputError("hold: nothing is held; give a force or a displacement other than zero.")

    @property
    def time_step(self) -> float:
        """Length of a step.

        Returns
        -------
        float
            [s].
        """
        return self.duration_s / self.steps

    @property
    def band(self) -> tuple[float, float]:
        """Frequencies that a law must hold for.

        Returns
        -------
        tuple of float
            [Hz]: 1 / (2 pi t) at the last and at the first time t.
        """
        return 0.5 / math.pi / self.duration_s, 0.5 / math.pi / self.time_step


@dataclass(frozen=True)
class Fall(Ranged):
    """How a specimen falls, and how that is computed.

    `height` of its lowest point over the floor in m; `tilt` of its axis from upright in degrees; `sawn` is the place of
    the saw as a share of the length from the foot, 0 for none; `duration` and `time_step` in s; `frames` counts the
    instants kept, the first included.

    >>> Fall(duration=0.1).steps
    500
    """

    height: float = option(
        "Over the floor.", 0.02, name="height_m", key="height_mm", unit=1e-3, low=0.0, high=10.0
    )
    tilt: float = option("Of its axis from upright.", 75.0, key="tilt_deg", low=-180.0, high=180.0)
    sawn: float = option(
        "Where it is sawn in two, as a share of its length from the foot; 0: nowhere.",
        0.5,
        low=0.0,
        below=1.0,
    )
    duration: float = option("How long it is followed.", 0.5, key="duration_s", above=0.0, high=100.0)
    time_step: float = option("Time step.", 2e-4, key="time_step_s", low=1e-7, high=1e-2)
    frames: int = option("Instants to keep for ParaView.", 50, low=2, high=10_000)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.steps > MOST_STEPS_OF_FALL:
            raise InputError(
                f"fall: {self.steps:.3g} steps of {self.time_step:g} s; it takes at most {MOST_STEPS_OF_FALL:g}: "
                "raise the "
                "time step, or follow it for less long."
            )

    @property
    def steps(self) -> int:
        """How many."""
        return max(1, round(self.duration / self.time_step))


@dataclass(frozen=True)
class FatigueLaw(Ranged):
    """How fast a bond tires: each cycle adds 1e-6 (e / endured)^exponent to its damage, and at 1 it is lost.

    e is the amplitude of its opening over its length.

    Parameters
    ----------
    endured : float
        The e that uses a bond up in a million cycles.
    exponent : float
        Minus one over the slope b of the Wöhler line of specimens, log e = log e6 + b log (N / 1e6).

    Examples
    --------
    >>> law = FatigueLaw(endured=100e-6, exponent=5.0)
    >>> round(law.rate(200e-6), 9)
    3.2e-05
    """

    endured: float = option(
        "Amplitude of strain that uses a bond up in a million cycles.", 100e-6, range=STRAINS
    )
    exponent: float = option("By which its life falls with strain.", 5.0, low=1.0, high=20.0)

    def rate(self, amplitude: np.ndarray) -> np.ndarray:
        """Damage per cycle.

        Parameters
        ----------
        amplitude : ndarray (b,)
            Of the strain of each bond, its opening over its length.

        Returns
        -------
        ndarray (b,)
            Damage that one cycle adds.
        """
        return (amplitude / self.endured) ** self.exponent / MILLION
