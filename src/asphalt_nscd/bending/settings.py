"""What a user sets of a test on a specimen. No numpy, for command line and schema ask it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.files.options import Ranged, option
from asphalt_nscd.measurements.kinds import usual_steps_per_cycle

if TYPE_CHECKING:
    from asphalt_nscd.measurements.shape import Shape

# blocked, |E*| of the paper's specimen is 2.6 times that of its law, free 1.1 (bond_readings.csv)
HEADS = ("free", "blocked")
METHODS = ("reduced", "condensed", "sweeps", "harmonic")
SCHEMES = ("euler", "fitted")
MOST_STEPS = 5_000_000  # of a test, which keeps some 200 bytes of each


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
    # with 0.35 the network as a whole shows 0.16
    poisson: float = option(default=0.35, above=-1.0, high=0.5)
    # with 1 the network has the modulus of the law (facet_network)
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
