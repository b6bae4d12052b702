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
        Rotation of the driven head, free as the form factor assumes, or blocked.
    poisson : float
        Poisson's ratio in Eqs. (8)-(11), which give a bond's tangential stiffness from its normal one. Used
        with area paper.
    kt_over_kn : float
        Tangential over normal stiffness of a bond. Used with area facets; with 1 a uniform strain is exact in
        any packing.
    yield_Pa : float
        Stress at which a bond between two spheres breaks, Pa.
    friction : float
        Coefficient of friction where a bond is broken or a gap closes.

    Examples
    --------
    >>> Bonds(head="blocked", yield_Pa=5e6).kt_over_kn
    1.0
    """

    head: str = option(default="free", choices=HEADS)
    # a network then shows 0.16
    poisson: float = option(default=0.35, above=-1.0, high=0.5)
    # one is the modulus of the law (facet_network)
    kt_over_kn: float = option(default=1.0, low=1e-4, high=10.0)
    # the paper's, which names no test behind it
    yield_Pa: float = option(default=2.7e6, low=1.0)
    friction: float = option(default=0.7, low=0.0, high=100.0)


@dataclass(frozen=True)
class Numerics(Ranged):
    """How a test is computed.

    Parameters
    ----------
    time_step : float
        Time step, s. Other tests than two-point bending take 200 steps per cycle unless it is given.
    rest_steps : int
        Time steps at rest under gravity before the test.
    method : str
        Reduced form, full condensed system, plain Gauss-Seidel on the bonds, or steady oscillation.
    scheme : str
        Implicit Euler, or BDF2 fitted to the frequency: exact in steady oscillation, 100 steps a cycle do.
    tolerance : float
        Relative change per sweep that stops Gauss-Seidel.
    most_sweeps : int
        Largest number of Gauss-Seidel sweeps in a step.

    Examples
    --------
    >>> Numerics(time_step=1e-3).scheme
    'euler'
    """

    # at 15 degC and 3 Hz solved steps from 2e-5 to 2e-4 s give one |E*| within 0.03 % (docs/results.md)
    time_step: float = option(default=5e-5, key="time_step_s", above=0.0)
    rest_steps: int = option(default=1000, low=0, high=MOST_STEPS)
    method: str = option(default="reduced", choices=METHODS)
    scheme: str = option(default="euler", choices=SCHEMES)
    tolerance: float = option(default=1e-4, low=0.0)
    most_sweeps: int = option(default=50, low=1, high=100_000)

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
        Amplitude of the head's displacement, m. Default is the paper's 63e-6 in two-point bending, and what
        strains other specimens by 50e-6.
    cycles : float
        Number of cycles, starting from rest.
    rig : Rig
        Devices at the head, and errors of the measuring channel.
    frames : int
        Instants of the last cycle of which to keep the motion of all spheres and the forces of all bonds; 24
        bytes a sphere and 12 a bond each, before they are packed.
    amplitude_N : float, optional
        Amplitude of the force, N: it is commanded, the displacement measured, and the weight tared.

    Examples
    --------
    >>> Load(frames=24).cycles
    5.0
    """

    amplitude_m: float | None = option(default=None, low=1e-15, high=1.0)
    cycles: float = option(default=5.0, low=1.0)
    rig: Rig = Rig()
    frames: int = option(default=0, low=0, high=10_000)
    amplitude_N: float | None = option(default=None, low=1e-9, high=1e9)


@dataclass(frozen=True)
class Hold(Ranged):
    """What is held, for how long, in how many equal steps.

    Parameters
    ----------
    duration_s : float
        How long, s.
    steps : int
        Equal time steps; errors fall with their length.
    force_N : float, optional
        Force held, N: creep.
    displacement_m : float, optional
        Displacement of the head held, m: relaxation. The default, at the amplitude of usual tests.

    Raises
    ------
    InputError
        For force and displacement together, or a zero held.

    Examples
    --------
    >>> Hold(duration_s=10.0, steps=500, force_N=300.0).time_step
    0.02
    """

    duration_s: float = option(default=10.0, low=1e-6, high=1e9)
    steps: int = option(default=1000, low=10, high=MOST_STEPS)
    force_N: float | None = option(default=None, low=-1e9, high=1e9)
    displacement_m: float | None = option(default=None, low=-1.0, high=1.0)

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
        Amplitude of strain that uses a bond up in a million cycles.
    exponent : float
        By which its life falls with strain.

    Examples
    --------
    >>> law = FatigueLaw(endured=100e-6, exponent=5.0)
    >>> round(law.rate(200e-6), 9)
    3.2e-05
    """

    endured: float = option(default=100e-6, range=STRAINS)
    exponent: float = option(default=5.0, low=1.0, high=20.0)

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
