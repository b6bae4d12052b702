"""The forecast held against mixes whose binder was measured too: what each part of the physics is worth, and who else
does as well.

Of each mix the law of the binder makes the forecast, and the law of the mix is the truth; both are 2S2P1D fits to
measurements, as published. All mixes of the table share one recipe.
"""

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.optimize import least_squares, minimize_scalar, nnls

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.film import Solid
from asphalt_nscd.forecasting.forecast import LevelResult, Networks, Settings, forecast, kept_in, modulus_of
from asphalt_nscd.forecasting.recipe import UNSTATED, Recipe, read_recipe
from asphalt_nscd.forecasting.rivals import RIVALS
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import Arrhenius
from asphalt_nscd.rheology.spectrum import Spectrum
from forecast.differential import FINE, RIGDEN, differential
from forecast.packings import OTHER_CUTS

PRINTED = Solid(95e9, 0.17)
"""What the documentation of MeanFieldHom.jl gives the aggregate (docs/src/applications/bituminous.md)."""
DIFFERENTIAL: dict[str, Callable[[Recipe], np.ndarray]] = {
    "differential": partial(differential, steps=FINE),
    "differential, filler by Rigden": partial(differential, steps=FINE, rigden=RIGDEN),
}
CALIBRATED_ON, SHIFTED_ON, SHIFTED = "H0", "W0", "W"  # the shift is that of the warm mixes' binder
PRESSURES = (0.1e3, 0.3e3, 1e3, 3e3, 10e3)  # Pa
ANY = Limits(0.0, 1e12, "give a number that is not negative")
COLUMNS = {
    "static_modulus": ("E00_MPa", 1e6),
    "glassy_modulus": ("E0_MPa", 1e6),
    "delta": ("delta", 1.0),
    "tau": ("tau_s", 1.0),
    "k": ("k", 1.0),
    "h": ("h", 1.0),
    "beta": ("beta", 1.0),
}
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

    def binder(self, decades: float = 0.0) -> np.ndarray:
        """E* of the binder (n,) [Pa], frequencies raised by `decades`: above 0 it is stiffer than the recovered one."""
        return self.recipe.binder.complex_modulus(self.omega * 10.0**decades, self.recipe.temperature)


def read_pairs(table: str | Path, recipe: Recipe) -> list[Pair]:
    """Mixes whose binder was measured too, one for each state of the table; the recipe gives all else."""
    rows = read_csv(table)
    rows.require(["ageing_state", "level", *(column for column, _ in COLUMNS.values())])
    laws: dict[tuple[str, str], TwoS2P1D] = {}
    numbers = {name: scale * rows.numbers(column, ANY) for name, (column, scale) in COLUMNS.items()}
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


def rungs(settings: Settings) -> Iterator[tuple[str, Settings]]:
    """Name and settings of each rung: what the forecast gains with each part of its physics, and loses without it."""
    bare = replace(settings, squeezed=False, touching=False, voids=False, skeleton_pressure=0.0)
    yield "levels", bare
    yield "+ squeezed films", replace(bare, squeezed=True)
    yield "+ grains that touch", replace(bare, squeezed=True, touching=True)
    yield "+ dry skeleton", replace(settings, voids=False)
    yield "+ air voids: the forecast", settings
    yield "without squeezed films", replace(settings, squeezed=False)
    yield "without grains that touch", replace(settings, touching=False)
    yield "without dry skeleton", replace(settings, skeleton_pressure=0.0)
    for name, cuts in OTHER_CUTS.items():
        yield f"levels: {name}", replace(settings, cuts=cuts)


def compare(pairs: list[Pair], networks: Networks) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Errors of each rung and rival against each measured mix, and the points of the last rungs.

    factor_rms is exp of the root mean square of ln(|E*| / measured), phase_rms_deg that of the phase.
    """
    recipe, settings = pairs[0].recipe, Settings()
    made: dict[str, tuple[str, int, Callable[[Pair], np.ndarray]]] = {}
    for name, rival in {**RIVALS, **DIFFERENTIAL}.items():
        made[name] = "rival", 0, partial(_rival, rival)
    for name, chosen in rungs(settings):
        levels = networks.chain(recipe, chosen, 1)
        made[name] = "forecast", 0, partial(_forecast, levels, recipe.aggregate)
    levels = networks.chain(replace(recipe, aggregate=PRINTED), settings, 1)
    made[f"aggregate {PRINTED.modulus / 1e9:.0f} GPa, as the source prints"] = (
        "forecast",
        0,
        partial(_forecast, levels, PRINTED),
    )
    by_name = {pair.name: pair for pair in pairs}
    calibrated_on, shifted_on = by_name[CALIBRATED_ON], by_name[SHIFTED_ON]
    fitted, levels = calibrated(calibrated_on, settings, networks)
    made[
        f"aggregate {fitted.recipe.aggregate.modulus / 1e9:.0f} GPa and skeleton "
        f"{fitted.settings.skeleton_pressure / 1e3:.2g} kPa, set on {CALIBRATED_ON}"
    ] = "calibrated", 2, partial(_forecast, levels, fitted.recipe.aggregate)
    fitted, levels = calibrated(calibrated_on, settings, networks, shifted=True)
    hot, stone = fitted.decades, recipe.aggregate
    made[
        f"binder {_stiffer(hot)} and skeleton {fitted.settings.skeleton_pressure / 1e3:.2g} kPa, set on {CALIBRATED_ON}"
    ] = "calibrated", 2, partial(_shifted, levels, stone, hot)
    warm = binder_shift(shifted_on, partial(modulus_of, levels, stone))
    made[f"and {SHIFTED} binders {_stiffer(warm)} instead, set on {SHIFTED_ON}"] = (
        "calibrated",
        3,
        lambda pair: _shifted(levels, stone, warm if pair.name.startswith(SHIFTED) else hot, pair),
    )
    own = measured_map(calibrated_on)
    made[f"no particle: measured map of binder to mix of {CALIBRATED_ON}"] = (
        "measured",
        0,
        lambda pair: own(pair.binder()),
    )
    # As much later than the hot ones as their mix is not.
    later = decades_slower(shifted_on.mix, calibrated_on.mix, shifted_on) - decades_slower(
        shifted_on.recipe.binder, calibrated_on.recipe.binder, shifted_on
    )
    made[f"that map, and {SHIFTED} binders {_stiffer(later)}"] = (
        "measured",
        1,
        lambda pair: own(pair.binder(later if pair.name.startswith(SHIFTED) else 0.0)),
    )
    best = best_map(pairs)
    made["best map of binder to mix, fitted to all"] = (
        "bound",
        len(best),
        lambda pair: _any_map(pair.binder()) @ best,
    )
    errors, points = [], []
    for name, (kind, parameters, modulus) in made.items():
        for pair in pairs:
            found = modulus(pair)
            off = np.log(found / pair.measured)
            has_phase = bool(np.iscomplexobj(found) and np.any(found.imag))
            errors.append(
                {
                    "forecast": name,
                    "kind": kind,
                    "parameters": parameters,
                    "mix": pair.name,
                    "factor_rms": float(np.exp(np.sqrt((off.real**2).mean()))),
                    "phase_rms_deg": float(np.degrees(np.sqrt((off.imag**2).mean())))
                    if has_phase
                    else np.nan,
                }
            )
            points += [
                {
                    "forecast": name,
                    "mix": pair.name,
                    "omega_rad_s": w,
                    "E_MPa": 1e-6 * abs(e),
                    "phase_deg": np.degrees(np.angle(e)) if has_phase else np.nan,
                    "measured_E_MPa": 1e-6 * abs(m),
                    "measured_phase_deg": np.degrees(np.angle(m)),
                }
                for w, e, m in zip(pair.omega, found, pair.measured, strict=True)
            ]
    return pd.DataFrame(errors), pd.DataFrame(points)


def _rival(rival: Callable[[Recipe], np.ndarray], pair: Pair) -> np.ndarray:
    return rival(pair.recipe)


def _forecast(levels: tuple[LevelResult, ...], stone: Solid, pair: Pair) -> np.ndarray:
    return _shifted(levels, stone, 0.0, pair)


def _shifted(levels: tuple[LevelResult, ...], stone: Solid, decades: float, pair: Pair) -> np.ndarray:
    return modulus_of(levels, stone, pair.binder(decades))


def _stiffer(decades: float) -> str:
    """Than recovered: as at frequencies so many decades higher."""
    return f"{abs(decades):.2f} decades {'stiffer' if decades > 0.0 else 'softer'}"


@dataclass(frozen=True)
class Calibrated:
    """Two inputs set on one mix: pressure in dry contacts; modulus of the aggregate, or the shift of the binder."""

    recipe: Recipe
    settings: Settings
    decades: float = 0.0


def calibrated(
    pair: Pair, settings: Settings, networks: Networks, shifted: bool = False
) -> tuple[Calibrated, tuple[LevelResult, ...]]:
    """Two inputs set on one mix: those that the source leaves open, or, `shifted`, the binder in the mix for the first.

    The pressure is the best of PRESSURES; with each the modulus is fitted to the maps of the usual one, since they know
    ratios of moduli alone, but for the bulk modulus of the binder. The best is solved anew. `shifted` sets the binder's
    frequencies in place of the modulus of the aggregate, by at most one decade up or down.
    """
    usual = pair.recipe.aggregate.modulus

    def fitted(levels: tuple[LevelResult, ...]) -> tuple[float, float]:
        def off(x: np.ndarray) -> np.ndarray:
            stone, decades = pair.recipe.aggregate, float(x[0])
            if not shifted:
                stone, decades = replace(stone, modulus=usual * float(np.exp(x[0]))), 0.0
            found = np.log(_shifted(levels, stone, decades, pair) / pair.measured)
            return np.concatenate([found.real, found.imag])

        best = least_squares(off, np.zeros(1), bounds=(-1.0, 1.0))
        return float(best.cost), float(best.x[0])

    tried = []
    for pressure in PRESSURES:
        chosen = replace(settings, skeleton_pressure=pressure)
        tried.append((*fitted(networks.chain(pair.recipe, chosen, 1)), chosen))
    _, found, chosen = min(tried, key=lambda one: one[0])
    if shifted:
        return Calibrated(pair.recipe, chosen, found), networks.chain(pair.recipe, chosen, 1)
    stone = replace(pair.recipe.aggregate, modulus=usual * float(np.exp(found)))
    recipe = replace(pair.recipe, aggregate=stone)
    return Calibrated(recipe, chosen), networks.chain(recipe, chosen, 1)


def measured_map(pair: Pair) -> Callable[[np.ndarray], np.ndarray]:
    """E* of a mix [Pa] where its binder has the |E*| given [Pa], as both were measured: it knows of no particle."""
    omega = np.geomspace(1e-12, 1e12, 4000)  # rad/s, beyond all binders of the table
    temperature = pair.recipe.temperature[0]
    binder = np.log(np.abs(pair.recipe.binder.complex_modulus(omega, temperature)))
    mix = np.log(pair.mix.complex_modulus(omega, temperature))
    return lambda modulus: np.exp(np.interp(np.log(np.abs(modulus)), binder, mix))


def decades_slower(law: Spectrum, other: Spectrum, pair: Pair) -> float:
    """Decades, -4 to 4, of frequency by which a law is slower than another at the points of a pair."""
    own = law.complex_modulus(pair.omega, pair.recipe.temperature)

    def misfit(decades: float) -> float:
        moved = other.complex_modulus(pair.omega * 10.0**decades, pair.recipe.temperature)
        return float((np.abs(np.log(own / moved)) ** 2).sum())

    return float(minimize_scalar(misfit, bounds=(-4.0, 4.0), method="bounded").x)


def binder_shift(pair: Pair, made: Callable[[np.ndarray], np.ndarray]) -> float:
    """Decades, -3 to 3, by which to raise the binder's frequencies so that a mix is met best; least squares of ln E*.

    `made` gives E* of the mix (n,) [Pa] for that of the binder (n,) [Pa].
    """

    def misfit(decades: float) -> float:
        off = np.log(made(pair.binder(decades)) / pair.measured)
        return float((np.abs(off) ** 2).sum())

    return float(minimize_scalar(misfit, bounds=(-3.0, 3.0), method="bounded").x)


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


def bands(pairs: list[Pair], networks: Networks) -> pd.DataFrame:
    """What the band of a forecast holds of each mix, its share for the model's own error taken from the others alone.

    Per mix: deviation_E of ln|E*| and deviation_phase_deg, root mean squares of the others; shares of its points that
    lie in the band of stated doubts, and in that with these deviations (`Forecast.band`).
    """
    made = {pair.name: forecast(pair.recipe, networks, seeds=(1,)) for pair in pairs}
    off = {pair.name: np.log(made[pair.name].modulus / pair.measured) for pair in pairs}
    rows = []
    for pair in pairs:
        others = np.array([off[other.name] for other in pairs if other is not pair])
        own = complex(np.sqrt((others.real**2).mean()), np.sqrt((others.imag**2).mean()))
        row = {"mix": pair.name, "deviation_E": own.real, "deviation_phase_deg": float(np.degrees(own.imag))}
        for name, model in (("doubts", 0j), ("band", own)):
            half = made[pair.name].band(model)
            row[f"E_in_{name}"] = float((np.abs(off[pair.name].real) <= half.real).mean())
            row[f"phase_in_{name}"] = float((np.abs(off[pair.name].imag) <= half.imag).mean())
        rows.append(row)
    return pd.DataFrame(rows)


def overall(errors: pd.DataFrame) -> pd.DataFrame:
    """One row for each forecast: errors of each mix and of all together."""
    rows = []
    for name, group in errors.groupby("forecast", sort=False):
        rows.append(
            {
                "forecast": name,
                "parameters": int(group["parameters"].iloc[0]),
                "factor_all": float(np.exp(np.sqrt((np.log(group["factor_rms"]) ** 2).mean()))),
                "phase_all_deg": float(np.sqrt((group["phase_rms_deg"] ** 2).mean())),
                **{
                    f"factor_{mix}": value
                    for mix, value in zip(group["mix"], group["factor_rms"], strict=True)
                },
                **{
                    f"phase_{mix}_deg": value
                    for mix, value in zip(group["mix"], group["phase_rms_deg"], strict=True)
                },
            }
        )
    return pd.DataFrame(rows)


if __name__ == "__main__":
    sys.stdout = sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    given, made = snakemake.input, snakemake.output
    networks = Networks(kept_in(given.packings))
    pairs = read_pairs(given.mixes, read_recipe(given.recipe))
    errors, points = compare(pairs, networks)
    tables = {"errors": errors, "points": points, "overall": overall(errors), "bands": bands(pairs, networks)}
    for name, table in tables.items():
        write_table(made[name], table)
