"""Spheres poured, vibrated and brought to rest: the content of a deposit file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.contents import DEPOSIT, Content
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.deposit import (
    REST_SPEED,
    PouringHistory,
    Progress,
    balance,
    settle,
    vibrate,
)
from asphalt_nscd.specimen.given_spheres import TOUCHING, overlaps, require_spheres
from asphalt_nscd.specimen.granular_bed import GranularBed, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.settings import LONGEST_POURING, LONGEST_REST, Pouring
from asphalt_nscd.specimen.trimming import layer_height

DENSITY = 2600.0  # kg/m3 while pouring, section 3.2.1
OUT_OF_BALANCE = 0.01  # of the weight, and of the mean contact force: a layer at rest has a twentieth of it
DEEP = 0.05  # of the smallest radius: an overlap that a layer at rest does not have
DEEPEST = 0.5  # of the smaller radius: an overlap that pouring on does not undo


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
    given = pouring.surfaces
    wall_friction = given.friction if given.wall_friction is None else given.wall_friction
    law = ContactLaw(float(given.friction), float(wall_friction), float(given.rolling_friction))
    return GranularBed.spheres_in_box(position, radius, pouring.box, DENSITY, law, given.restitution)


def _settled(bed: GranularBed, pouring: Pouring, progress: Progress) -> Content:
    """Let a bed come to rest, vibrate it, and let it come to rest; content of its deposit file."""
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
        "friction": bed.law.friction,
        "wall_friction": bed.law.wall_friction,
        **({"rolling_friction": bed.law.rolling} if bed.law.rolling else {}),
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
    """Bring the layer into equilibrium; attributes that describe it then, and its way there."""
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
