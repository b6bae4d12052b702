"""Which input of a recipe is wrong: a mix held against a reference of the same recipe whose inputs are right.

What the forecast itself gets wrong is the same for both and cancels in ln(E* of the mix / E* of the reference). What is
left is compared with what each input alone would change. Its size is free; its shape may be off by SHAPE. A binder that
is stiffer by a shift in time moves the mix along the reference's own curve (in the Black diagram: on it), whatever the
model: that change is taken from the reference and not from the forecast.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import make_interp_spline

from asphalt_nscd.files.csvinput import Limits, read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.forecast import Networks, Settings, kept_in, modulus_of
from asphalt_nscd.forecasting.recipe import Recipe, read_recipe

SIZES: dict[str, tuple[float, ...]] = {
    "air voids": (-0.03, -0.015, 0.0, 0.015, 0.03, 0.05),  # of the volume
    "binder content": (-0.005, 0.0, 0.005),  # of the mass
    "binder stiffness": (-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5),  # decades of time, up is stiffer
    "dry contacts": (-1.0, 0.0, 0.5, 1.0, 2.0, 3.0),  # decades of the pressure in them
}
REACH = {"binder content": (-0.02, 0.02)}
"""Further than SIZES, straight on: with 1 % more binder stones fill less than half and would touch no more at once."""
UNITS = {
    "air voids": (100.0, "%"),
    "binder content": (100.0, "% by mass"),
    "binder stiffness": (1.0, "decades"),
}
FINE = 41  # sizes at which each input is tried
SHAPE = 1.0  # of a change: how far its shape over frequency may be off, one standard deviation
SHAPE_OF_REFERENCE = 0.3  # likewise of one along the reference's curve: binders that age flatten too
DEGREE = 6  # of the polynomial through the reference's curve, at most a third of its points
WEAKER = 3.0  # by so much another model may be less sensitive to an input; limits count on it
ALONG = 1.5  # decades of frequency over which it is off alike
# Standard deviations of ln|E*| and phase [rad] of a mean of specimens over another: all points, tilt, each point.
LEVEL, TILT, POINT = 0.05, 0.01, 0.02
PHASE, PHASE_POINT = np.radians(0.5), np.radians(0.5)
DENSITY, MAXIMUM = 0.003, 0.002  # of the logarithms of bulk and maximum density, likewise
NOTICED, NAMED = 12.0, 6.0  # twice the gain of log likelihood over no error, and over another input
NAMED_SHARE = 0.001  # of the gain over no error, if that is more: where gains are large, so are misfits


@dataclass(frozen=True)
class Changes:
    """What each input changes, by its name, for errors of several sizes.

    `omega` (n,) [rad/s] is reduced to one temperature where there are several; `size` (sizes,) is how far the input is
    off; `log` (sizes, n) and `density` (sizes, 2) are changes of ln E* and of ln of bulk and maximum density; `shape`
    is how far each may be off, at all sizes and points or at each (sizes, n).
    """

    omega: np.ndarray
    size: dict[str, np.ndarray]
    log: dict[str, np.ndarray]
    density: dict[str, np.ndarray]
    shape: dict[str, float | np.ndarray]


@dataclass(frozen=True)
class Finding:
    """What is wrong. inputs: none where nothing is, several where they cannot be told apart; the likeliest first."""

    inputs: tuple[str, ...]
    gain: dict[str, float]  # twice the gain of log likelihood of each input over no error
    size: dict[str, float]  # that fits best


def name_wrong_input(
    recipe: str | Path,
    measured: str | Path,
    reference: str | Path,
    packings: str | Path,
    output: str | Path,
    weighed: tuple[float, float] | None = None,
) -> tuple[str, ...]:
    """The inputs that may be wrong, the likeliest first, with a table of all in `output`.

    `weighed` are measured bulk and maximum density of the doubted mix [kg/m3]. Packings that lack are poured.
    """
    if weighed and weighed[0] > weighed[1]:
        raise InputError("The bulk density is above the maximum; give the bulk density first.")
    asked, ratio, known = read_ratio(measured, reference, read_recipe(recipe))
    changes = changes_of(asked, Networks(kept_in(packings)))
    density = np.log(np.array(weighed) / densities(asked)) if weighed else None
    finding = find(along_reference(changes, known), ratio, density)
    write_table(output, table(finding, limits(changes, density is not None)))
    return finding.inputs


def read_ratio(
    measured: str | Path, reference: str | Path, recipe: Recipe
) -> tuple[Recipe, np.ndarray, np.ndarray]:
    """A mix beside its reference, at the points that both tables share; rows of one point are averaged.

    Returns the recipe with these points, ln(E* of the first / of the second) (n,) and ln E* of the second (n,). Refuses
    fewer than three shared points, and temperatures that the binder's law lacks.
    """
    mix, known = (_by_point(path) for path in (measured, reference))
    shared = mix.index.intersection(known.index)
    if len(shared) < 3:
        raise InputError(f"{measured}: shares {len(shared)} points with {reference}; at least 3 are needed.")
    base = known.loc[shared].to_numpy()
    ratio = mix.loc[shared].to_numpy() - base
    temperature, frequency = np.array([*shared]).T
    only = recipe.binder.shift.reference_temperature
    if not recipe.shifted and (temperature != only).any():
        raise InputError(
            f"{measured}: temperature_C differs from {only:g} degC, at which alone the binder's law holds; add "
            f"binder.shift to the recipe."
        )
    return replace(recipe, temperature=temperature, frequency=frequency), ratio, base


def _by_point(path: str | Path) -> pd.Series:
    """ln E* by temperature and frequency."""
    table = read_csv(path)
    table.require(["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"])
    size = table.numbers("E_MPa", Limits(1e-3, 1e5, "give it in MPa"))
    phase = np.radians(table.numbers("phase_deg", Limits(-5.0, 90.0, "give it in degrees")))
    at = {name: table.numbers(name) for name in ("temperature_C", "frequency_Hz")}
    table.numbers("frequency_Hz", Limits(1e-8, 1e6, "give it in Hz, above zero"))
    frame = pd.DataFrame(at | {"log": np.log(size) + 1j * phase})
    return frame.groupby(["temperature_C", "frequency_Hz"])["log"].mean()


def densities(recipe: Recipe) -> np.ndarray:
    """Bulk and maximum density (2,) [kg/m3] of the mix of a recipe."""
    share = recipe.binder_share
    maximum = 1.0 / (share / recipe.binder_density + (1.0 - share) / recipe.aggregate_density)
    return np.array([maximum * (1.0 - recipe.voids), maximum])


def changed(recipe: Recipe, name: str, size: float) -> Recipe:
    """The recipe with one input off by `size`, in its unit; stiffness and contacts do not stand in it."""
    if name == "air voids":
        return replace(recipe, voids=max(recipe.voids + size, 0.0))
    return replace(recipe, binder_share=recipe.binder_share + size) if name == "binder content" else recipe


def changes_of(recipe: Recipe, networks: Networks) -> Changes:
    """What each input changes by the forecast at the points of the recipe, straight between SIZES."""

    def forecast(name: str, size: float) -> tuple[np.ndarray, np.ndarray]:
        other, chosen, faster = changed(recipe, name, size), Settings(), 1.0
        if name == "dry contacts":
            chosen = replace(chosen, skeleton_pressure=chosen.skeleton_pressure * 10.0**size)
        elif name == "binder stiffness":
            faster = 10.0**size
        binder = recipe.binder.complex_modulus(2.0 * np.pi * faster * recipe.frequency, recipe.temperature)
        levels = networks.chain(other, chosen, 1)
        return np.log(modulus_of(levels, recipe.aggregate, binder)), np.log(densities(other))

    fine, log, density = {}, {}, {}
    for name, sizes in SIZES.items():
        found = [forecast(name, size) for size in sizes]
        at_zero = found[sizes.index(0.0)]
        low, high = REACH.get(name, (sizes[0], sizes[-1]))
        fine[name] = np.union1d(np.linspace(low, high, FINE), 0.0)
        log[name], density[name] = (
            make_interp_spline(sizes, np.array([one[k] for one in found]), k=1)(fine[name]) - at_zero[k]
            for k in (0, 1)
        )
    shift = recipe.binder.shift.factor(recipe.temperature) if recipe.shifted else 1.0
    shape: dict[str, float | np.ndarray] = dict.fromkeys(SIZES, SHAPE)
    return Changes(2.0 * np.pi * recipe.frequency * shift, fine, log, density, shape)


def along_reference(changes: Changes, reference: np.ndarray) -> Changes:
    """The changes, that by a stiffer binder taken from the reference, ln E* (n,), as far as it was measured."""
    decades, name = np.log10(changes.omega), "binder stiffness"
    degree = min(DEGREE, decades.size // 3)
    # powers of a coordinate of order one: those of decades themselves are nearly the same column
    middle, span = 0.5 * (decades.min() + decades.max()), max(float(np.ptp(decades)), 1e-9)

    def curve(at: np.ndarray) -> np.ndarray:
        basis = np.vander((at - middle) / span, degree + 1)
        return basis @ fitted

    fitted = np.linalg.lstsq(np.vander((decades - middle) / span, degree + 1), reference, rcond=None)[0]
    at = decades + changes.size[name][:, None]
    inside = (at >= decades.min()) & (at <= decades.max())
    moved = np.array([curve(row) for row in at]) - curve(decades)
    log = changes.log | {name: np.where(inside, moved, changes.log[name])}
    own = np.where(inside, SHAPE_OF_REFERENCE, SHAPE)
    return replace(changes, log=log, shape=changes.shape | {name: own})


def find(changes: Changes, ratio: np.ndarray, density: np.ndarray | None = None) -> Finding:
    """Which inputs explain a mix beside its reference, by `ratio` (n,), complex ln(E* of mix / reference).

    `density` (2,) is ln of bulk and maximum density over the recipe's; without it most inputs cannot be told apart.
    """
    gain, best = {}, {}
    for name, sizes in changes.size.items():
        tried = _log_likelihood(changes, ratio, density, name)
        gain[name] = float(2.0 * (tried.max() - tried[sizes == 0.0][0]))
        best[name] = float(sizes[int(np.argmax(tried))])
    order = sorted(gain, key=lambda name: -gain[name])
    largest = gain[order[0]]
    if largest < NOTICED:
        return Finding((), gain, best)
    lead = max(NAMED, NAMED_SHARE * largest)
    likely = [name for name in order if gain[name] > largest - lead]
    if density is None and likely != [
        "binder stiffness"
    ]:  # the others soften or stiffen alike (docs/forecast.md)
        likely += [name for name in order if name not in likely and name != "binder stiffness"]
    return Finding(tuple(likely), gain, best)


def limits(changes: Changes, weighed: bool) -> dict[str, float]:
    """Smallest error of each input that is noticed without scatter; NaN where none in its range is.

    `weighed` says that the densities are known too.
    """
    found = {}
    for name, sizes in changes.size.items():
        found[name] = np.nan
        for k in np.flatnonzero(sizes > 0.0):
            density = changes.density[name][k] if weighed else None
            if find(changes, changes.log[name][k] / WEAKER, density).inputs:
                found[name] = float(sizes[k])
                break
    return found


def table(finding: Finding, limit: dict[str, float]) -> pd.DataFrame:
    """A row for each input of a finding: the size that fits best, its gain of likelihood, whether it is named."""
    rows = []
    for name, gain in finding.gain.items():
        scale, unit = UNITS.get(name, (1.0, "decades of pressure"))
        rows.append(
            {
                "input": name,
                "unit": unit,
                "off_by": scale * finding.size[name],
                "limit": scale * limit[name],
                "gain": gain,
                "named": name in finding.inputs,
            }
        )
    return pd.DataFrame(rows)


def _log_likelihood(changes: Changes, ratio: np.ndarray, density: np.ndarray | None, name: str) -> np.ndarray:
    """Of each size (s,) of an error of one input."""
    decades, log = np.log10(changes.omega), changes.log[name]
    n, tilt = decades.size, decades - decades.mean()
    alike = np.exp(-0.5 * ((decades[:, None] - decades) / ALONG) ** 2)
    largest = np.abs(log.imag).max(axis=1, keepdims=True)
    parts = (
        (ratio.real - log.real, log.real, LEVEL**2 + TILT**2 * np.outer(tilt, tilt), POINT),
        (ratio.imag - log.imag, largest * np.ones(n), PHASE**2, PHASE_POINT),
    )
    total = np.zeros(len(log))
    for left, size, common, point in parts:
        off = changes.shape[name] * np.abs(size)
        total += _normal(
            left,
            common + point**2 * np.eye(n) + off[:, :, None] * off[:, None] * alike,
        )
    if density is not None:
        off = (density - changes.density[name]) / [DENSITY, MAXIMUM]
        total -= 0.5 * (off**2).sum(axis=1)
    return total


def _normal(value: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Logarithm of the density (s,) of normal distributions at values (s, n), without its constant."""
    root = np.linalg.cholesky(covariance)
    scaled = np.linalg.solve(root, value[..., None])[..., 0]
    return np.asarray(
        -0.5 * (scaled**2).sum(axis=1) - np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
    )
