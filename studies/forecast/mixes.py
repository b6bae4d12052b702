"""The forecast held against mixes whose binder was measured too, and who else does as well.

Of each mix the law of the binder makes the forecast, and the law of the mix is the truth; both are 2S2P1D fits to
measurements, as published. All mixes of the table share one recipe.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import least_squares, minimize_scalar, nnls

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.binders import LAW_KEYS, UNSTATED, BinderLaw
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import RIVALS
from asphalt_nscd.forecasting.scheme import USUAL, Settings, modulus_of_mix
from asphalt_nscd.forecasting.solid import Solid
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import Arrhenius

PRINTED = Solid(95e9, 0.17)
"""What the documentation of MeanFieldHom.jl gives the aggregate (docs/src/applications/bituminous.md)."""
FORECAST = "forecast"
HOT, WARM = "H0", "W0"  # the first of the hot mixes and of the warm ones
ANY = Limits(0.0, 1e12, "give a number that is not negative")
ANY_MAP = np.geomspace(1e-4, 1e4, 33) * 1e6  # Pa, poles of a map that knows the measurements


@dataclass(frozen=True)
class Pair:
    """A mix, and what its binder is."""

    name: str
    recipe: Recipe  # with its binder
    mix: TwoS2P1D

    @property
    def omega(self) -> np.ndarray:
        """Angular frequencies (n,) [rad/s] of the recipe."""
        return 2.0 * np.pi * self.recipe.frequency

    @property
    def measured(self) -> np.ndarray:
        """E* [Pa] of the mix at the points of the recipe."""
        return self.mix.complex_modulus(self.omega, self.recipe.temperature)

    @property
    def measured_phase(self) -> np.ndarray:
        """Of the mix (n,) [degrees]."""
        return np.degrees(np.angle(self.measured))

    def binder(self, decades: float = 0.0) -> np.ndarray:
        """E* of the binder (n,) [Pa], frequencies raised by `decades`: above 0 it is stiffer than the recovered one."""
        return self.recipe.binder.complex_modulus(self.omega * 10.0**decades, self.recipe.temperature)


def read_pairs(table: str | Path, recipe: Recipe) -> list[Pair]:
    """Mixes whose binder was measured too, one for each state of the table; the recipe gives all else."""
    rows = read_csv(table)
    rows.require(["ageing_state", "level", *LAW_KEYS])
    laws: dict[tuple[str, str], TwoS2P1D] = {}
    numbers = {name: scale * rows.numbers(key, ANY) for key, (name, scale) in LAW_KEYS.items()}
    for row, key in enumerate(zip(rows.columns["ageing_state"], rows.columns["level"], strict=True)):
        values = {name: float(column[row]) for name, column in numbers.items()}
        refusal = TwoS2P1D.refusal(values)
        if refusal:
            raise rows.error(row, f"{refusal}; correct it.")
        # The shift is never asked: all points are at the one temperature of the laws.
        laws[key] = TwoS2P1D(**values, shift=Arrhenius(150e3, UNSTATED))
    return [
        Pair(state, replace(recipe, name=state, binder=law, shifted=False), laws[state, "mix"])
        for (state, level), law in laws.items()
        if level == "binder"
    ]


def compare(pairs: list[Pair]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Errors of each forecast and rival against each measured mix, and their points.

    factor_rms is exp of the root mean square of ln(|E*| / measured), phase_rms_deg that of the phase.
    """
    errors, points = [], []
    for name, (parameters, modulus) in _forecasts(pairs).items():
        for pair in pairs:
            found = modulus(pair)
            off = np.log(found / pair.measured)
            # Witczak's regression is of |E*| alone.
            phase = np.degrees(np.angle(found)) if np.any(found.imag) else np.full(found.size, np.nan)
            error = {"forecast": name, "parameters": parameters, "mix": pair.name}
            error["factor_rms"] = float(np.exp(np.sqrt((off.real**2).mean())))
            error["phase_rms_deg"] = float(np.sqrt(((phase - pair.measured_phase) ** 2).mean()))
            errors.append(error)
            table = pd.DataFrame({"forecast": name, "mix": pair.name, "omega_rad_s": pair.omega})
            table["E_MPa"], table["phase_deg"] = 1e-6 * np.abs(found), phase
            table["measured_E_MPa"] = 1e-6 * np.abs(pair.measured)
            table["measured_phase_deg"] = pair.measured_phase
            points.append(table)
    return pd.DataFrame(errors), pd.concat(points)


def _forecasts(pairs: list[Pair]) -> dict[str, tuple[int, Callable[[Pair], np.ndarray]]]:
    """By name: how many numbers are fitted to these mixes, and E* [Pa] of a mix."""

    def made(pair: Pair, settings: Settings = USUAL, stone: Solid | None = None) -> np.ndarray:
        recipe = replace(pair.recipe, aggregate=stone or pair.recipe.aggregate)
        return modulus_of_mix(recipe, pair.binder(), settings)

    own, best = measured_map(pairs[0]), best_map(pairs)
    first = {pair.name: pair for pair in pairs}
    # As much later than the hot ones as their mix is not.
    hot, warm = first[HOT], first[WARM]
    later = decades_slower(warm.mix, hot.mix, warm)
    later -= decades_slower(warm.recipe.binder, hot.recipe.binder, warm)
    return {
        **{name: (0, partial(_rival, rival)) for name, rival in RIVALS.items()},
        "forecast without skeleton": (0, partial(made, settings=Settings(pressure=0.0))),
        FORECAST: (0, made),
        f"aggregate {PRINTED.modulus / 1e9:.0f} GPa, as the source prints": (0, partial(made, stone=PRINTED)),
        "that, and a gap of 100 nm": (0, partial(made, stone=PRINTED, settings=Settings(gap=100e-9))),
        f"no recipe: measured map of binder to mix of {HOT}": (0, lambda pair: own(pair.binder())),
        f"that map, and {WARM[0]} binders {abs(later):.2f} decades {'stiffer' if later > 0.0 else 'softer'}": (
            1,
            lambda pair: own(pair.binder(later if pair.name.startswith(WARM[0]) else 0.0)),
        ),
        "best map of binder to mix, fitted to all": (len(best), lambda pair: _any_map(pair.binder()) @ best),
    }


def _rival(rival: Callable[[Recipe], np.ndarray], pair: Pair) -> np.ndarray:
    return rival(pair.recipe)


def measured_map(pair: Pair) -> Callable[[np.ndarray], np.ndarray]:
    """E* of a mix [Pa] where its binder has the |E*| given [Pa], as both were measured: it knows of no particle."""
    omega = np.geomspace(1e-12, 1e12, 4000)  # rad/s, beyond all binders of the table
    temperature = pair.recipe.temperature[0]
    binder = np.log(np.abs(pair.recipe.binder.complex_modulus(omega, temperature)))
    mix = np.log(pair.mix.complex_modulus(omega, temperature))
    return lambda modulus: np.exp(np.interp(np.log(np.abs(modulus)), binder, mix))


def decades_slower(law: BinderLaw, other: BinderLaw, pair: Pair) -> float:
    """Decades, -4 to 4, of frequency by which a law is slower than another at the points of a pair."""
    own = law.complex_modulus(pair.omega, pair.recipe.temperature)

    def misfit(decades: float) -> float:
        moved = other.complex_modulus(pair.omega * 10.0**decades, pair.recipe.temperature)
        return float((np.abs(np.log(own / moved)) ** 2).sum())

    return float(minimize_scalar(misfit, bounds=(-4.0, 4.0), method="bounded").x)


def best_map(pairs: list[Pair]) -> np.ndarray:
    """Weights (35,) of the Stieltjes function of the binder's modulus that comes nearest to all mixes of one recipe.

    They are not negative: of a constant, of the modulus x itself, and of x / (1 + x / pole) for each pole in ANY_MAP.
    No forecast that knows the recipe and the binder alone can come much nearer: it is one such function.
    """
    basis = np.vstack([_any_map(pair.binder()) for pair in pairs])
    measured = np.concatenate([pair.measured for pair in pairs])
    relative = basis / np.abs(measured)[:, None]
    unit = measured / np.abs(measured)
    # Relative errors first, which are linear in the weights: a start for errors of ln E*, which are not.
    start = nnls(np.vstack([relative.real, relative.imag]), np.concatenate([unit.real, unit.imag]))[0]
    kept = start > 0.0  # weights that are zero have no logarithm to be refined

    def off(logs: np.ndarray) -> np.ndarray:
        found = np.log(basis[:, kept] @ np.exp(logs) / measured)
        return np.concatenate([found.real, found.imag])

    weights = np.zeros(start.size)
    weights[kept] = np.exp(least_squares(off, np.log(start[kept])).x)
    return weights


def _any_map(binder: np.ndarray) -> np.ndarray:
    """Terms (n, 35) of a Stieltjes function of the binder's modulus [Pa]."""
    x = binder[:, None]
    # The constant in MPa, so that its weight is of the size of the others.
    return np.hstack([np.full_like(x, 1e6), x, x / (1.0 + x / ANY_MAP)])


def overall(errors: pd.DataFrame) -> pd.DataFrame:
    """One row for each forecast: errors of each mix and of all together."""
    rows = []
    for name, group in errors.groupby("forecast", sort=False):
        factor, phase = (group.set_index("mix")[column] for column in ("factor_rms", "phase_rms_deg"))
        row = {"forecast": name, "parameters": int(group["parameters"].iloc[0])}
        row["factor_all"] = float(np.exp(np.sqrt((np.log(factor) ** 2).mean())))
        row["phase_all_deg"] = float(np.sqrt((phase**2).mean()))
        row |= {f"factor_{mix}": value for mix, value in factor.items()}
        rows.append(row | {f"phase_{mix}_deg": value for mix, value in phase.items()})
    return pd.DataFrame(rows)


def run(job: Any) -> None:
    """From the files of the rule to its tables."""
    given, made = job.input, job.output
    errors, points = compare(read_pairs(given.mixes, read_recipe(given.recipe)))
    for name, table in {"errors": errors, "points": points, "overall": overall(errors)}.items():
        write_table(made[name], table)


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
