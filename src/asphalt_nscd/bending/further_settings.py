"""What a user sets of a hold, a ramp, a fall and fatigue. No numpy, for the command line asks it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from asphalt_nscd.bending.settings import MOST_STEPS
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.options import Ranged, option
from asphalt_nscd.files.ranges import Range

if TYPE_CHECKING:
    import numpy as np

MOST_STEPS_OF_FALL = 1_000_000  # of some milliseconds each
MILLION = 1e6  # cycles, to which epsilon6 refers
STRAINS = Range(low=1e-8, high=0.1)


def _require_one(name: str, force: float | None, displacement: float | None) -> None:
    if force is not None and displacement is not None:
        raise InputError(f"{name}: give force_N or displacement_m, that of what is commanded.")
    if 0.0 in (force, displacement):
        raise InputError(f"{name}: nothing moves; give a force or a displacement other than zero.")


class _EqualSteps(Ranged):
    """What a hold and a ramp share."""

    duration_s: float
    steps: int

    @property
    def time_step(self) -> float:
        """Length of a step [s]."""
        return self.duration_s / self.steps

    @property
    def band(self) -> tuple[float, float]:
        """Frequencies [Hz] that a law must hold for: 1 / (2 pi t) at the last and at the first time t."""
        return 0.5 / math.pi / self.duration_s, 0.5 / math.pi / self.time_step


@dataclass(frozen=True)
class Hold(_EqualSteps):
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
        _require_one("hold", self.force_N, self.displacement_m)


@dataclass(frozen=True)
class Ramp(_EqualSteps):
    """How a specimen is pulled or pushed at constant speed until it fails, and on.

    Parameters
    ----------
    duration_s : float
        How long, s.
    steps : int
        Equal time steps; the curve and the order of breaks get finer with them.
    displacement_m : float, optional
        Displacement of the head at the end, m. The default, at 20 amplitudes of usual tests.
    force_N : float, optional
        Force at the end, N: it is commanded, and the record ends where the specimen is in two pieces.
    frames : int
        Instants to keep with all spheres and bonds, for ParaView.

    Raises
    ------
    InputError
        For force and displacement together, or a zero.

    Examples
    --------
    >>> Ramp(duration_s=0.1, steps=500).time_step
    0.0002
    """

    duration_s: float = option(default=0.1, low=1e-6, high=1e9)
    steps: int = option(default=400, low=10, high=MOST_STEPS)
    displacement_m: float | None = option(default=None, low=-1.0, high=1.0)
    force_N: float | None = option(default=None, low=-1e9, high=1e9)
    frames: int = option(default=0, low=0, high=10_000)

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_one("ramp", self.force_N, self.displacement_m)


@dataclass(frozen=True)
class Cycling(Ranged):
    """A force commanded from rest on a specimen whose grains touch, and how its record is read.

    Parameters
    ----------
    amplitude_m : float, optional
        Amplitude of the head's displacement that the force would cause if no contact slipped, m. The default, that of
        usual tests.
    pressure_Pa : float
        Pressure on the skeleton of grains, by compaction or confinement, Pa. Forces of contacts are exponential about
        its mean.
    skeleton_friction : float
        Coefficient of friction between the grains.
    haversine : bool
        The force presses only; else it pulls as much as it presses.
    all_cycles : int
        Cycles from rest.
    read_cycles : int
        Cycles that are read, the last ones.
    drift : bool
        The fit to the record has a term for its drift.
    steps_in_cycle : int
        Time steps in a cycle, by a scheme fitted to it.

    Raises
    ------
    InputError
        If more cycles are read than there are.

    Examples
    --------
    >>> Cycling(pressure_Pa=500e3).haversine
    True
    """

    amplitude_m: float | None = option(default=None, low=1e-12, high=1e-3)
    pressure_Pa: float = option(default=10e3, low=1.0, high=10e6)
    skeleton_friction: float = option(default=0.5, low=0.0, high=10.0)
    haversine: bool = option(default=True)
    all_cycles: int = option(default=10, low=1, high=1000)
    read_cycles: int = option(default=5, low=1, high=1000)
    drift: bool = option(default=True)
    steps_in_cycle: int = option(default=32, low=20, high=1000)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.read_cycles > self.all_cycles:
            raise InputError(
                f"cycles: {self.read_cycles} are read of {self.all_cycles}; give fewer read_cycles."
            )


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
    rolling_friction: float = option(
        "Couple that resists rolling, over the force that presses and the radius.", 0.0, low=0.0, high=10.0
    )

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
        """Number of time steps."""
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
