"""Spheres poured, vibrated and brought to rest: the content of a deposit file."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range, Ranged, within
from asphalt_nscd.files.store import load, save
from asphalt_nscd.nscd.cores import cores
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.contents import DEPOSIT, Content
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.deposit import (
    REST_SPEED,
    PouringHistory,
    Progress,
    Vibration,
    balance,
    settle,
    vibrate,
)
from asphalt_nscd.specimen.given_spheres import TOUCHING, overlaps, require_spheres
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.trimming import layer_height

LARGEST_BOX = 10.0  # m
DENSITY = 2600.0  # kg/m3 while pouring, section 3.2.1
LONGEST_POURING = 3.0  # s; the fall from 1.6 m takes 0.6
LONGEST_REST = 0.3  # s
OUT_OF_BALANCE = 0.01  # of the weight, and of the mean contact force: a layer at rest has a twentieth of it
DEEP = 0.05  # of the smallest radius: an overlap that a layer at rest does not have
FEWEST_STEPS = 10  # in a period of the vibration
MOST_STEPS = 500_000  # of a pouring and its vibration
DEEPEST = 0.5  # of the smaller radius: an overlap that pouring on does not undo


@dataclass(frozen=True)
class Surfaces(Ranged):
    """Surfaces of grains and walls while they are poured.

    Parameters
    ----------
    friction : float
        Coefficient between spheres.
    wall_friction : float, optional
        Coefficient with walls; None for that between spheres.
    restitution : float
        Of an impact, with spheres and walls.

    Examples
    --------
    >>> Surfaces(friction=0.3, wall_friction=0.0).friction  # rough grains between smooth walls
    0.3
    """

    friction: float = within(0.2, low=0.0, high=100.0)
    # smooth walls lower the usual layer from 63.5 to 62.1 mm (docs/pouring.md)
    wall_friction: float | None = within(None, low=0.0, high=100.0)
    restitution: float = within(0.0, low=0.0, below=1.0)


@dataclass(frozen=True)
class Pouring(Ranged):
    """Where spheres fall, and how: `box` is length, width, height [m], `time_step` [s]; `threads` change no number."""

    box: tuple[float, float, float]
    seed: int = within(0, low=0)
    surfaces: Surfaces = Surfaces()
    vibration: Vibration = Vibration()
    # shorter steps change neither height nor overlap; at 0.2 ms fast grains exchange no false impulse
    time_step: float = within(4e-4, "time_step_s", low=1e-6, high=1e-3)
    threads: int = 1

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


def deposit(
    spheres: str | Path,
    pouring: Pouring,
    output: str | Path,
    progress: Progress = lambda stage, done, total: None,
) -> Mapping[str, Any]:
    """Pour a table of spheres, or go on from a deposit file (.h5), and save; returns the attributes of the file."""
    path = Path(spheres)
    if path.suffix == ".h5":
        kept = load(path, DEPOSIT).arrays
        arrays, attributes = pour_on(kept["position"], kept["radius"], pouring, progress)
    else:
        arrays, attributes = pour(read_counts(path), pouring, progress)
    save(output, DEPOSIT, arrays, attributes)
    return attributes


def pour(
    spheres: tuple[np.ndarray, np.ndarray],
    pouring: Pouring,
    progress: Progress = lambda stage, done, total: None,
) -> Content:
    """Pour spheres, given by diameters [m] and counts, and vibrate them; returns content of a deposit file."""
    rng = np.random.default_rng(pouring.seed)
    bed = _bed(*random_lattice(*spheres, pouring.box, rng), pouring)
    bed.let_fall()
    return _settled(bed, pouring, progress)


def pour_on(
    position: np.ndarray,
    radius: np.ndarray,
    pouring: Pouring,
    progress: Progress = lambda stage, done, total: None,
) -> Content:
    """Pour on from where spheres stand, `position` (n, 3), `radius` (n,) in m; returns content of a deposit file."""
    require_spheres("packing", position, radius)
    slack = DEEP * radius.min()
    low, high = position - radius[:, None], position + radius[:, None]
    # so asked that NaN is outside
    if not ((low >= -slack).all() and (high <= np.asarray(pouring.box) + slack).all()):
        raise InputError(
            f"box_m = {pouring.box}: spheres of the packing lie outside; give a box that holds them."
        )
    deepest = overlaps(position, radius)
    # spheres in one place would all be pairs, and part so slowly that pouring took hours
    if deepest.share > DEEPEST:
        first, second = deepest.pair
        raise InputError(
            f"packing: spheres {first} and {second} overlap by {deepest.share:.0%} of the smaller radius; give spheres "
            "apart from each other."
        )
    return _settled(_bed(position, radius, pouring), pouring, progress)


def _bed(position: np.ndarray, radius: np.ndarray, pouring: Pouring) -> GranularBed:
    surfaces = pouring.surfaces
    return GranularBed.in_box(
        position,
        radius,
        pouring.box,
        DENSITY,
        surfaces.friction,
        surfaces.restitution,
        surfaces.wall_friction,
    )


def _settled(bed: GranularBed, pouring: Pouring, progress: Progress) -> Content:
    """Let a bed come to rest, vibrate it, and let it come to rest."""
    began = time.process_time()
    box, vibration, position, radius = pouring.box, pouring.vibration, bed.position.copy(), bed.radius
    numerics = PouringNumerics.of(radius, pouring.time_step)
    # the weight of the layer: 16 times as much lowers it by 0.4 mm more, and presses grains into each other
    history, pressure = (
        PouringHistory(),
        bed.weight() / (box[0] * box[1]) if vibration.duration > 0.0 else 0.0,
    )
    with Team(pouring.threads) as bed.team:
        settle(bed, numerics, REST_SPEED, LONGEST_POURING, progress, "pouring")
        stages = {"poured": _stage(bed, numerics, PouringHistory(), progress, "settling")}
        poured = bed.position.copy()
        if vibration.duration > 0.0:
            history.note(bed)
            vibrate(bed, numerics, vibration, pressure, history, progress)
            settle(bed, numerics, REST_SPEED, LONGEST_REST, progress, "coming to rest")
            stages["vibrated"] = _stage(bed, numerics, history, progress, "coming to rest")
            history.note(bed)
    last = stages["vibrated" if vibration.duration > 0.0 else "poured"]
    if last["largest_overlap_m"] > DEEP * radius.min():
        raise InputError(
            f"grains overlap by {1e3 * last['largest_overlap_m']:.2g} mm at rest, which rigid ones cannot; lower the "
            "time step, or leave out the smallest spheres."
        )
    attributes = {
        "seed": pouring.seed,
        "friction": bed.friction,
        "wall_friction": bed.friction if bed.wall_friction is None else bed.wall_friction,
        "restitution": bed.restitution,
        "stroke_m": vibration.stroke,
        "vibration_Hz": vibration.frequency,
        "vibration_s": vibration.duration,
        "wall_pressure_Pa": pressure,
        "spheres": radius.size,
        "highest_point_m": bed.top(),
        "steps": bed.steps,
        "sweeps": bed.sweeps,
        **last,
        **{f"poured_{name}": value for name, value in stages["poured"].items()},
        "kinetic_energy_J": bed.kinetic_energy(),
        **asdict(numerics),
        "cpu_s": time.process_time() - began,
    }
    bodies, force = bed.contact_forces(pouring.time_step)
    arrays = {
        "contacts/bodies": bodies,
        "contacts/force": force,
        "initial_position": position,
        "poured_position": poured,
        "position": bed.position,
        "radius": radius,
        "box": np.asarray(box, float),
        **history.arrays(),
    }
    return arrays, attributes


def unrest(attributes: Mapping[str, Any]) -> str:
    """A sentence on a layer whose forces are not in equilibrium; empty for a layer at rest."""
    carried, unbalanced = attributes["weight_balance"], attributes["unbalanced_force"]
    if max(carried, unbalanced) <= OUT_OF_BALANCE:
        return ""
    return (
        f"the layer is not at rest: the force on the walls differs by {carried:.1%} from its weight, and grains bear "
        f"{unbalanced:.1%} of a contact force too much; pour with more friction or less restitution, or into a wider "
        "box."
    )


def _stage(
    bed: GranularBed, numerics: PouringNumerics, history: PouringHistory, progress: Progress, name: str
) -> dict[str, float]:
    """Bring the layer into equilibrium; what is said of it then, and of its way there."""
    moving, bed.overlap = bed.overlap, 0.0
    weight_balance, unbalanced = balance(bed, numerics, LONGEST_REST, progress, name)
    contacts, gap = bed.contacts(TOUCHING)
    box = (bed.plane_point[3, 0], bed.plane_point[4, 1], bed.top())
    touched = np.array(history.touched)
    return {
        **layer_statistics(bed.position, bed.radius, box, contacts),
        "largest_overlap_m": float(max(0.0, -gap.min(initial=0.0))),
        "weight_balance": weight_balance,
        "unbalanced_force": unbalanced,
        "periods": touched.size,
        "periods_with_contact": int((touched > 0).sum()),
        "grains_touched_per_period": float(touched.mean()) if touched.size else 0.0,
        "largest_overlap_moving_m": moving,
    }


def layer_statistics(
    position: np.ndarray, radius: np.ndarray, box: tuple[float, float, float], contacts: np.ndarray
) -> dict[str, float]:
    """Height, solid fraction, coordination and segregation of a layer, by the names of the file's attributes.

    `position` (n, 3), `radius` (n,) and `box` in m, `contacts` (c, 2) are bodies. Segregation is the difference between
    the mean heights of the largest and of the smallest spheres over the height of the layer: zero when mixed, positive
    when large spheres are on top.
    """
    n, height = radius.size, layer_height(position, radius)
    between = contacts[(contacts < n).all(axis=1)]
    largest, smallest = radius == radius.max(), radius == radius.min()
    return {
        "layer_height_m": height,
        "solid_fraction": float((4.0 / 3.0 * np.pi * radius**3).sum() / (box[0] * box[1] * height)),
        "coordination": 2.0 * len(between) / n,
        "segregation": float((position[largest, 2].mean() - position[smallest, 2].mean()) / height),
    }
