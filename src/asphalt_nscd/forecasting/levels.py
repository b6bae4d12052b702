"""The grading cut into levels: the grains of each lie in the mix of all finer ones and of the binder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.recipe import Recipe

CUTS = (0.063e-3, 2e-3)  # m: filler, sand, stones
NAMES = {1: ("mix",), 2: ("mortar", "mix"), 3: ("mastic", "mortar", "mix")}
RANGE = 5.0  # largest over smallest grain of a packing; finer grains of the level count in its fraction
CLASSES = 6  # sizes of a packing
TOUCHING = 0.5
"""Fraction from which the grains of a level touch: loose crushed aggregate has 40 to 50 % of voids (AASHTO T 304)."""
DENSEST = 0.70  # of a level: more than its packings reach

# Surface factors [m2/kg] of the Asphalt Institute (Hveem): times the share that passes each sieve [mm]; 0.41 for all.
SURFACE = {4.75: 0.41, 2.36: 0.82, 1.18: 1.64, 0.6: 2.87, 0.3: 6.14, 0.15: 12.29, 0.075: 32.77}
SURFACE_OF_ALL = 0.41


@dataclass(frozen=True, eq=False)
class Level:
    """Grains between two sizes [m] in a matrix of everything finer.

    `fraction` is the volume of its grains over that of grains and matrix, without air; `diameter` (c,) [m] are the
    classes of the packing and `share` (c,) theirs of its volume.
    """

    name: str
    smallest: float
    largest: float
    fraction: float
    diameter: np.ndarray
    share: np.ndarray

    @property
    def touching(self) -> bool:
        """Whether its grains touch in the compacted mix."""
        return self.fraction >= TOUCHING


def levels_of(recipe: Recipe, cuts: tuple[float, ...] = CUTS) -> list[Level]:
    """Levels of a recipe from the finest up, cut at sizes [m]; levels without grains are left out.

    Refuses a level with more grains than a packing can hold.
    """
    grading = recipe.grading
    edges = np.array([0.0, *cuts, np.inf])
    passing = np.array([0.0, *grading.passing_at(np.asarray(cuts)), 1.0])
    volume = recipe.aggregate_fraction * np.diff(passing)
    matrix, levels = 1.0 - recipe.aggregate_fraction, []
    names = NAMES.get(len(volume), tuple(f"level {k + 1}" for k in range(len(volume))))
    for k, grains in enumerate(volume):
        if grains > 1e-6:
            fraction = grains / (grains + matrix)
            if fraction > DENSEST:
                raise InputError(
                    f"{recipe.file}: grading: the grains of the {names[k]} fill {100 * fraction:.0f} % of it, more "
                    f"than a packing reaches ({100 * DENSEST:.0f} %); correct grading or binder_percent_by_mass."
                )
            levels.append(_level(names[k], edges[k], edges[k + 1], fraction, recipe))
        matrix += grains
    return levels


def _level(name: str, low: float, high: float, fraction: float, recipe: Recipe) -> Level:
    """A level whose packing holds its grains of the coarsest factor RANGE of sizes, as graded."""
    sieve, passing = recipe.grading.sieve, recipe.grading.passing
    finest = sieve[0]
    all_pass = sieve[np.flatnonzero(passing >= 1.0 - 1e-12)[0]]
    high = min(high, all_pass)
    low = max(low, high / RANGE)
    edges = np.geomspace(low, high, CLASSES + 1)
    share = np.diff(recipe.grading.passing_at(edges))
    if (
        high <= finest or share.sum() <= 0.0
    ):  # below the finest sieve nothing is known: evenly over log of size
        share = np.ones(CLASSES)
    kept = share > 1e-6 * share.sum()
    middle = np.sqrt(edges[1:] * edges[:-1])
    return Level(name, low, high, fraction, middle[kept], share[kept] / share[kept].sum())


def film_thickness(recipe: Recipe) -> float:
    """Mean thickness of the binder on the grains [m]: its volume over the surface of the aggregate (Hveem)."""
    surface = SURFACE_OF_ALL + sum(
        factor * float(recipe.grading.passing_at(sieve * 1e-3)) for sieve, factor in SURFACE.items()
    )
    volume = (
        recipe.binder_share / (1.0 - recipe.binder_share) / recipe.binder_density
    )  # m3 for a kg of aggregate
    return volume / surface
