"""What a user sets of a specimen: how it is poured and cut. No numpy, for command line and schema ask it."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.options import Ranged, option
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.nscd.cores import cores

AREAS = ("paper", "facets")
LARGEST_BOX = 10.0  # m
LONGEST_POURING = 3.0  # s; the fall from 1.6 m takes 0.6
LONGEST_REST = 0.3  # s
FEWEST_STEPS = 10  # in a period of the vibration
MOST_STEPS = 500_000  # of a pouring and its vibration


@dataclass(frozen=True)
class Surfaces(Ranged):
    """Surfaces of grains and walls while they are poured.

    Parameters
    ----------
    friction : float
        Coefficient of friction between spheres while pouring; with walls too, unless theirs is given.
    wall_friction : float, optional
        Coefficient of friction with walls; if not given, that between spheres.
    restitution : float
        Speed after an impact over that before it.
    rolling_friction : float
        Couple that resists the rolling of spheres, over the force that presses them and the radius, 1/R the sum
        of 1/radius; a sphere alone then rests on slopes up to this.

    Examples
    --------
    >>> Surfaces(friction=0.3, wall_friction=0.0).friction  # rough grains between smooth walls
    0.3
    """

    friction: float = option(default=0.2, low=0.0, high=100.0)
    # smooth walls lower the usual layer from 63.5 to 62.1 mm (docs/pouring.md)
    wall_friction: float | None = option(default=None, low=0.0, high=100.0)
    restitution: float = option(default=0.0, low=0.0, below=1.0)
    rolling_friction: float = option(default=0.0, low=0.0, high=10.0)


@dataclass(frozen=True)
class Vibration(Ranged):
    """Vibration of the top wall, after pouring.

    Parameters
    ----------
    stroke : float
        Stroke of the top wall from crest to crest, about the top of the layer, m.
    frequency : float
        Frequency of the top wall, Hz.
    duration : float
        Duration of the vibration, s; 0 for none.

    Examples
    --------
    >>> Vibration(duration=0.0).stroke  # pour without; the stroke of the paper
    0.006
    """

    stroke: float = option(
        "Stroke of the top wall from crest to crest, about the top of the layer, mm.",
        6e-3,
        name="stroke_m",
        key="stroke_mm",
        unit=1e-3,
        low=0.0,
        high=1.0,
    )
    frequency: float = option(default=30.0, name="frequency_Hz", key="vibration_Hz", above=0.0, high=1e3)
    duration: float = option(default=1.0, name="duration_s", key="vibration_s", low=0.0, high=60.0)


@dataclass(frozen=True)
class Pouring(Ranged):
    """Where spheres fall, and how: `box` is length, width, height [m], `time_step` [s]; `threads` change no number."""

    box: tuple[float, float, float] = option("Length,width,height of the box, m.", key="box_m")
    seed: int = option("Seed of the random lattice.", 0, low=0)
    surfaces: Surfaces = Surfaces()
    vibration: Vibration = Vibration()
    # shorter steps change neither height nor overlap; at 0.2 ms fast grains exchange no false impulse
    time_step: float = option(
        "Time step of pouring and vibrating, s.", 4e-4, key="time_step_s", low=1e-6, high=1e-3
    )
    threads: int = option(
        "Threads to compute on, at most as many as the cores granted; they change no number.", 1
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        box = self.box
        if len(box) != 3 or not all(Range(above=0.0).holds(side) for side in box):
            raise InputError(f"box_m = {box}: give length, width and height in m, greater than zero.")
        if max(box) > LARGEST_BOX:
            raise InputError(
                f"a box of {box[0]:g} x {box[1]:g} x {box[2]:g} m is longer than {LARGEST_BOX:g} m; give its sides in "
                "m, not in mm."
            )
        frequency = self.vibration.frequency
        period = 1.0 / (frequency * self.time_step)
        if self.vibration.duration > 0.0 and period < FEWEST_STEPS:
            raise InputError(
                f"vibration: {period:.2g} steps of {self.time_step:g} s in a period of {frequency:g} Hz do not follow "
                f"it; give a time step of {1.0 / (frequency * FEWEST_STEPS):.2g} s or less."
            )
        steps = (LONGEST_POURING + 3.0 * LONGEST_REST + self.vibration.duration) / self.time_step
        if steps > MOST_STEPS:
            raise InputError(
                f"pouring: up to {steps:.3g} steps of {self.time_step:g} s; it takes at most {MOST_STEPS:g}: raise the "
                "time step, or vibrate for less long."
            )
        if not 1 <= self.threads <= cores():
            raise InputError(
                f"threads = {self.threads}: give a whole number from 1 to {cores()}, the cores that this machine "
                "grants."
            )


@dataclass(frozen=True)
class Cutting(Ranged):
    """How the spheres that are cut out are shrunk and bonded.

    `volume_reduction` is the part of each sphere's volume that mastic takes. Pairs with a gap below `gap_max_mm` are
    bonded by area "paper"; `area` is one of `AREAS`.
    """

    volume_reduction: float = option(
        "Fraction of the spheres' volume that is removed to make room for the mastic.",
        0.1,
        low=0.0,
        below=1.0,
    )
    area: str = option(
        "Area of a bond. paper is pi rmin^2 of Eqs. (30)-(33). facets is the facet between the cells of two spheres; "
        "the cells fill the specimen (docs/mapping.md).",
        "paper",
        choices=AREAS,
    )
    gap_max_mm: float = option(
        "Spheres with a smaller gap are bonded, mm. Used with area paper; facets bond all neighbours.",
        2.0,
        above=0.0,
        high=100.0,
    )
