"""The forecast of a recipe: E* at its points, how sure it is, and what each input moves."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from asphalt_nscd.forecasting.recipe import Grading, Recipe
from asphalt_nscd.forecasting.scheme import FILLER, USUAL, Settings, modulus_of_mix, require_free_binder

# What an input of the recipe may be off by, and a number of the model, in words; each changes |E*| by so much as
# `Forecast.moved` tells.
INPUTS = {
    "voids": "the air voids, + 0.5 %",
    "binder": "the binder content, + 0.2 %",
    "filler": "the share of filler, + 1 %",
    "rigden": "the voids of the dry filler, + 5 %",
    "stiffness": "a binder stiffer as at twice the frequency",
    "aggregate": "the modulus of the aggregate, x 1.25",
}
OF_THE_MODEL = {
    "contacts": "the number of contacts, x 1.5",
    "gap": "the gap in contacts, x 3",
    "pressure": "the pressure in dry contacts, / 3",
}
# Half width of the band of ln|E*| and of the phase [degrees] over |E*| [MPa]: 90 to 99 % of the errors on the mixes of
# `data/mixes50` stay within at each temperature (docs/forecast.md).
BAND = {
    "E_MPa": (400.0, 1000.0, 4000.0, 10000.0, 20000.0),
    "log": (1.1, 0.85, 0.8, 0.75, 0.6),
    "phase_deg": (15.0, 13.0, 13.0, 6.0, 6.0),
}


@dataclass(frozen=True)
class Forecast:
    """E* (n,) [Pa] of the mix at the points of its recipe.

    `moved` (n,) is the change of ln E* by each of INPUTS and OF_THE_MODEL, its real part of |E*| and its imaginary part
    of the phase.
    """

    recipe: Recipe
    settings: Settings
    modulus: np.ndarray
    moved: dict[str, np.ndarray]

    def modulus_at(self, omega: np.ndarray, temperature: float | np.ndarray) -> np.ndarray:
        """E* of the mix (n,) [Pa] at angular frequencies `omega` (n,) [rad/s] and temperatures [degC]."""
        at = np.broadcast_to(temperature, np.shape(omega))
        return modulus_of_mix(self.recipe, self.recipe.binder.complex_modulus(omega, at), self.settings)

    def band(self) -> np.ndarray:
        """Half width (n,) of the band of ln|E*| and, imaginary, of the phase [rad]."""
        place, known = np.log(np.abs(self.modulus)), np.log(1e6 * np.array(BAND["E_MPa"]))
        return np.interp(place, known, BAND["log"]) + 1j * np.radians(
            np.interp(place, known, BAND["phase_deg"])
        )


def forecast(recipe: Recipe, settings: Settings = USUAL) -> Forecast:
    """E* of the mix of a recipe, and what each of INPUTS and OF_THE_MODEL moves."""
    require_free_binder(recipe)
    modulus = _modulus(recipe, settings)
    moved = {
        name: np.log(_modulus(*changed, 2.0 if name == "stiffness" else 1.0)) - np.log(modulus)
        for name, changed in _changed(recipe, settings).items()
    }
    return Forecast(recipe, settings, modulus, moved)


def _modulus(recipe: Recipe, settings: Settings, faster: float = 1.0) -> np.ndarray:
    omega = 2.0 * np.pi * faster * recipe.frequency
    return modulus_of_mix(recipe, recipe.binder.complex_modulus(omega, recipe.temperature), settings)


def _changed(recipe: Recipe, settings: Settings) -> dict[str, tuple[Recipe, Settings]]:
    """By each of INPUTS and OF_THE_MODEL, recipe and settings with it changed; `stiffness` is changed by frequency."""
    stiffer = replace(recipe.aggregate, modulus=1.25 * recipe.aggregate.modulus)
    more = replace(settings, contacts=1.5 * settings.contacts)
    return {
        "voids": (replace(recipe, voids=recipe.voids + 0.005), settings),
        "binder": (replace(recipe, binder_share=recipe.binder_share + 0.002), settings),
        "filler": (replace(recipe, grading=refilled(recipe.grading, 0.01)), settings),
        "rigden": (replace(recipe, rigden_voids=recipe.rigden_voids + 0.05), settings),
        "stiffness": (recipe, settings),
        "aggregate": (replace(recipe, aggregate=stiffer), settings),
        "contacts": (recipe, more),
        "gap": (recipe, replace(settings, gap=3.0 * settings.gap)),
        "pressure": (recipe, replace(settings, pressure=settings.pressure / 3.0)),
    }


def refilled(grading: Grading, more: float) -> Grading:
    """The grading with a share `more` of filler in place of all that is coarser."""
    sieve = np.union1d(grading.sieve, [FILLER])
    passing, filler = grading.passing_at(sieve), float(grading.passing_at(FILLER))
    more = min(more, 1.0 - filler)
    coarser = (passing - filler) / max(1.0 - filler, 1e-9)
    raised = filler + more + coarser * (1.0 - filler - more)
    lowered = passing * (filler + more) / max(filler, 1e-9)
    return Grading(sieve, np.where(sieve >= FILLER, raised, lowered))
