"""The forecast: from the modulus of the binder, level by level, to that of the mix."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.film import Solid
from asphalt_nscd.forecasting.levels import CUTS, TOUCHING, Level, film_thickness, levels_of
from asphalt_nscd.forecasting.network import Contents, Physics, contents_of, level_map
from asphalt_nscd.forecasting.packing import LevelPacking, packing_of
from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.forecasting.static_map import StaticMap

Packings = Callable[[Level, int], LevelPacking]
"""The packing of a level and a seed."""


@dataclass(frozen=True)
class Settings:
    """What the forecast takes for granted: stated, not fitted (docs/forecast.md says why, and from where).

    `film_factor`: film between touching grains over the mean binder film; `touching_voids`: air voids, of the volume,
    at which the stones touch, each percent more sets them apart; `skeleton_pressure` [Pa] holds dry contacts together
    when the binder has relaxed; `binder_bulk`: K [Pa]; `cuts`: sizes between the levels [m]. The switches take physics
    away: the matrix nearly incompressible, grains of coarse levels that touch, films taken away by air.
    """

    film_factor: float = 1.0
    touching_voids: float = 0.04
    skeleton_pressure: float = 10e3
    binder_bulk: float = 2.5e9
    cuts: tuple[float, ...] = CUTS
    squeezed: bool = True
    touching: bool = True
    voids: bool = True


# Factor by which each stated number may be wrong, about two standard deviations; of air voids the difference.
DOUBTS: dict[str, float] = {"film_factor": 2.0, "skeleton_pressure": 10.0, "aggregate": 1.25, "voids": 0.005}

BINDER_STEP = 0.002
"""Of the mass of the mix: so much binder nobody vouches for, and an edge of the rules that is nearer is told."""

MODEL = complex(np.log(1.42), np.radians(7.1))
"""What the model itself gets wrong: root mean square of ln|E*| and of the phase [rad] over six mixes."""


@dataclass(frozen=True)
class LevelResult:
    """A level of a forecast, its packing, and its map from the modulus of its matrix to its own.

    `grains` counts those in the prism that is pulled, `densest` is the fraction that they fill unshrunk; `matrix_bulk`
    is K of its matrix [Pa].
    """

    level: Level
    packing: LevelPacking
    grains: int
    densest: float
    map: StaticMap
    matrix_bulk: float


@dataclass(frozen=True)
class Forecast:
    """E* (n,) [Pa] of the mix at the points of its recipe, and how it came about.

    `packed` holds the levels for each seed; `deviation` (n,) the change of ln E* by each doubt, its real part of |E*|
    and its imaginary part of the phase; `packing` in it is half the range over the seeds. `caution` says which rule the
    recipe stands at the edge of; empty where none is near.
    """

    recipe: Recipe
    settings: Settings
    packed: tuple[tuple[LevelResult, ...], ...]
    modulus: np.ndarray
    deviation: dict[str, np.ndarray]
    caution: str

    @property
    def levels(self) -> tuple[LevelResult, ...]:
        """Those of the first seed."""
        return self.packed[0]

    def modulus_at(self, omega: np.ndarray, temperature: float) -> np.ndarray:
        """E* of the mix (n,) [Pa] at angular frequencies `omega` (n,) [rad/s] and one temperature [degC]."""
        binder = self.recipe.binder.complex_modulus(omega, temperature)
        logs = [np.log(modulus_of(levels, self.recipe.aggregate, binder)) for levels in self.packed]
        return np.exp(np.mean(logs, axis=0))

    def band(self, model: complex) -> np.ndarray:
        """Half width (n,) of the band of ln|E*| and, imaginary, of the phase [rad].

        Root of the sum of squares of all deviations and of twice `model`, the root mean square of the model's own error
        of ln|E*| and, imaginary, of the phase [rad].
        """
        parts = np.array([*self.deviation.values()]).reshape(-1, self.modulus.size)
        # Twice the error of the model; the sizes of the doubts are about two standard deviations already.
        return np.sqrt((parts.real**2).sum(axis=0) + 4.0 * model.real**2) + 1j * np.sqrt(
            (parts.imag**2).sum(axis=0) + 4.0 * model.imag**2
        )


class Networks:
    """The packing of each level and seed, and the maps that were solved with them, each once."""

    def __init__(self, packings: Packings) -> None:
        self._packings = packings
        self._cut: dict[tuple, tuple[LevelPacking, Contents]] = {}
        self._maps: dict[tuple, StaticMap] = {}

    def chain(self, recipe: Recipe, settings: Settings, seed: int) -> tuple[LevelResult, ...]:
        """All levels, the finest first; what leaves one is the matrix of the next."""
        bulk, results = settings.binder_bulk, []
        found = levels_of(recipe, settings.cuts)
        for level in found:
            packing, contents = self._contents(level, seed)
            physics = physics_of(recipe, settings, level, last=level is found[-1])
            # All that a map rests on: a doubt about the stones solves no finer level again.
            key = (
                level.name,
                level.smallest,
                level.largest,
                level.fraction,
                seed,
                recipe.aggregate,
                bulk,
                physics,
            )
            if key not in self._maps:
                self._maps[key] = level_map(contents, level, recipe.aggregate, bulk, physics)
            grains, densest = contents.prism.radius.size, contents.solid_fraction
            results.append(LevelResult(level, packing, grains, densest, self._maps[key], bulk))
            # Reuss, to which the lower bound of Hashin & Shtrikman falls where the matrix flows.
            bulk = 1.0 / (level.fraction / recipe.aggregate.bulk + (1.0 - level.fraction) / bulk)
        return tuple(results)

    def _contents(self, level: Level, seed: int) -> tuple[LevelPacking, Contents]:
        key = (level.name, level.smallest, level.largest, seed)
        if key not in self._cut:
            packing = self._packings(level, seed)
            self._cut[key] = packing, contents_of(packing)
        return self._cut[key]


def forecast(
    recipe: Recipe,
    networks: Networks,
    settings: Settings = Settings(),
    seeds: tuple[int, ...] = (1, 2),
    progress: Callable[[str, float, float], None] = lambda stage, done, total: None,
) -> Forecast:
    """E* of the mix of a recipe: the geometric mean over packings of some seeds, with the doubts of the first."""
    doubts = _doubted(recipe, settings)
    stages, runs, made = len(seeds) + len(doubts), [], []
    for k, seed in enumerate(seeds):
        progress("networks", k, stages)
        made.append(networks.chain(recipe, settings, seed))
        runs.append(np.log(modulus_of(made[-1], recipe.aggregate, recipe.binder_modulus())))
    logs = np.array(runs)
    # Of two numbers half the range is the standard deviation too.
    deviation = {"packing": _half_range(logs)} if len(seeds) > 1 else {}
    for k, (name, (doubted, chosen)) in enumerate(doubts.items()):
        progress("networks", len(seeds) + k, stages)
        # In the same packing, so that a doubt holds nothing of the draw.
        levels = networks.chain(doubted, chosen, seeds[0])
        deviation[name] = np.log(modulus_of(levels, doubted.aggregate, doubted.binder_modulus())) - logs[0]
    progress("networks", stages, stages)
    caution = _caution(recipe, settings, networks, made[0], seeds[0])
    return Forecast(recipe, settings, tuple(made), np.exp(logs.mean(axis=0)), deviation, caution)


def physics_of(recipe: Recipe, settings: Settings, level: Level, last: bool) -> Physics:
    """What a level's films and contacts do; air voids and the dry skeleton belong to the coarsest, `last`.

    Films are thin only where the grains of the level touch.
    """
    touching = settings.touching and level.touching
    voids = recipe.voids if settings.voids and last else 0.0
    matrix = 1.0 - level.fraction * (1.0 - recipe.voids)  # and air, of the volume of the mix
    # loosening is a linear strain: a third of the volume by which air sets the stones apart
    return Physics(
        film=settings.film_factor * film_thickness(recipe) if touching else None,
        loosening=max(0.0, voids - settings.touching_voids) / 3.0 if voids else 0.0,
        void_share=voids / matrix,
        skeleton_pressure=settings.skeleton_pressure if touching and last else 0.0,
        squeezed=settings.squeezed,
    )


def modulus_of(levels: tuple[LevelResult, ...], aggregate: Solid, binder: np.ndarray) -> np.ndarray:
    """E* of the mix (n,) [Pa] for E* of the binder (n,) [Pa]; `levels` from the finest up."""
    ratio = binder / aggregate.modulus
    for result in levels:
        ratio = result.map(ratio)
    return ratio * aggregate.modulus


def _doubted(recipe: Recipe, settings: Settings) -> dict[str, tuple[Recipe, Settings]]:
    """The recipe and settings with one doubt each."""
    stiffer = replace(recipe.aggregate, modulus=recipe.aggregate.modulus * DOUBTS["aggregate"])
    changed = {
        "aggregate": (replace(recipe, aggregate=stiffer), settings),
        "film_factor": (recipe, replace(settings, film_factor=settings.film_factor * DOUBTS["film_factor"])),
        "skeleton_pressure": (
            recipe,
            replace(settings, skeleton_pressure=settings.skeleton_pressure / DOUBTS["skeleton_pressure"]),
        ),
        "voids": (replace(recipe, voids=recipe.voids + DOUBTS["voids"]), settings),
    }
    # What is switched off cannot be in doubt.
    unused = set() if settings.touching else {"film_factor", "skeleton_pressure"}
    unused |= set() if settings.voids else {"voids"}
    return {name: pair for name, pair in changed.items() if name not in unused}


def _caution(
    recipe: Recipe, settings: Settings, networks: Networks, levels: tuple[LevelResult, ...], seed: int
) -> str:
    """A sentence for each level BINDER_STEP from TOUCHING, or fuller than its packing, with what the step changes."""
    sentences = []
    for word, step in (("more", BINDER_STEP), ("less", -BINDER_STEP)):
        other = replace(recipe, binder_share=recipe.binder_share + step)
        with suppress(InputError):  # less binder may leave a level that no packing holds
            for there, result in zip(levels_of(other, settings.cuts), levels, strict=True):
                level = result.level
                if settings.touching and there.touching != level.touching:
                    edge = f"and from {100 * TOUCHING:.0f} % on they are taken to touch: "
                elif step > 0.0 and level.fraction > result.densest:
                    edge = f"of which the forecast sees the {100 * result.densest:.1f} % of their packing: "
                else:
                    continue
                moved = networks.chain(other, settings, seed)
                sentences.append(
                    f"The grains of the {level.name} fill {100 * level.fraction:.1f} % of it, {edge}"
                    f"{100 * BINDER_STEP:g} % {word} binder {_change(recipe, levels, moved)}."
                )
    return " ".join(sentences)


def _change(recipe: Recipe, levels: tuple[LevelResult, ...], moved: tuple[LevelResult, ...]) -> str:
    """From |E*| and phase of `levels` to those of `moved`, where |E*| changes most."""
    before, after = (
        modulus_of(chain, recipe.aggregate, recipe.binder_modulus()) for chain in (levels, moved)
    )
    k = int(np.abs(np.log(np.abs(after / before))).argmax())
    size = [float(f"{1e-6 * abs(modulus[k]):.3g}") for modulus in (before, after)]
    turned = [np.degrees(np.angle(modulus[k])) for modulus in (before, after)]
    return (
        f"changes |E*| from {size[0]:g} to {size[1]:g} MPa and the phase from {turned[0]:.0f} to {turned[1]:.0f}° "
        f"at {recipe.temperature[k]:g} °C and {recipe.frequency[k]:.2g} Hz"
    )


def _half_range(logs: np.ndarray) -> np.ndarray:
    return 0.5 * (np.ptp(logs.real, axis=0) + 1j * np.ptp(logs.imag, axis=0))


def kept_in(folder: str | Path, progress: Callable[[str, float, float], None] | None = None) -> Packings:
    """Packings in a folder, by level and seed, poured where they are missing; makes the folder."""
    Path(folder).mkdir(parents=True, exist_ok=True)

    def packing(level: Level, seed: int) -> LevelPacking:
        def stage(name: str, done: float, total: float) -> None:
            if progress is not None:
                progress(f"{level.name} {seed}: {name}", done, total)

        try:
            return packing_of(level, seed, Path(folder), stage)
        except InputError as error:
            raise InputError(f"{level.name}: {error}") from None

    return packing
