"""The packing of a level: poured once for a grading and kept. Its largest grain measures 10 mm, whatever the level."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from asphalt_nscd.files.store import load, save
from asphalt_nscd.forecasting.levels import Level
from asphalt_nscd.specimen.deposit import Progress
from asphalt_nscd.specimen.preparation import pour
from asphalt_nscd.specimen.settings import Pouring, Vibration

KIND = "level-packing"
LARGEST = 10e-3  # m, of the spheres that are poured: the numbers of the pouring are made for this size
WIDTH = 4.6  # of the box, in largest grains
HEIGHT = 6.0  # of the box over its width: room for the rain
LOOSE = 0.6  # solid fraction, of the spheres that are ordered
VIBRATION = 0.3  # s
MOST_SPHERES = 6000


@dataclass(frozen=True)
class LevelPacking:
    """Spheres at rest in a box [0, length] x [0, width], in packing units; `coordination`: mean contacts of one.

    `position` (n, 3), `radius` (n,) and `box` (3,), its length, width and height, in m.
    """

    position: np.ndarray
    radius: np.ndarray
    box: np.ndarray
    seed: int
    solid_fraction: float
    coordination: float


def packing_of(
    level: Level,
    seed: int,
    folder: Path,
    progress: Progress = lambda stage, done, total: None,
) -> LevelPacking:
    """The packing of a level for a seed of the lattice, poured if it is not in the folder."""
    diameter, count, width = ordered(level)
    path = folder / f"{level.name.replace(' ', '_')}_{_key(diameter, count)}_{seed}.h5"
    if not path.is_file():
        pouring = Pouring((width, width, HEIGHT * width), seed, vibration=Vibration(duration=VIBRATION))
        arrays, said = pour((diameter, count), pouring, progress)
        kept = {name: arrays[name] for name in ("position", "radius", "box")}
        save(path, KIND, kept, {name: said[name] for name in ("seed", "solid_fraction", "coordination")})
    record = load(path, KIND)
    arrays, said = record.arrays, record.attributes
    return LevelPacking(
        arrays["position"],
        arrays["radius"],
        arrays["box"],
        said["seed"],
        said["solid_fraction"],
        said["coordination"],
    )


def ordered(level: Level) -> tuple[np.ndarray, np.ndarray, float]:
    """What to pour for a level, in packing units: diameters (c,) [m], counts (c,) and width of the box [m]."""
    diameter = level.diameter * LARGEST / level.diameter.max()
    width = WIDTH * LARGEST
    count = level.share * LOOSE * width**3 / (np.pi / 6.0 * diameter**3)
    if count.sum() > MOST_SPHERES:
        width *= (MOST_SPHERES / count.sum()) ** (1.0 / 3.0)
        count *= MOST_SPHERES / count.sum()
    count = np.rint(count).astype(int)
    return diameter[count > 0], count[count > 0], width


def _key(diameter: np.ndarray, count: np.ndarray) -> str:
    # to a nanometre: rounding of the same grading pours no other packing
    said = np.round(diameter, 9).tobytes() + count.tobytes() + np.array([HEIGHT, VIBRATION]).tobytes()
    return hashlib.sha256(said).hexdigest()[:8]
