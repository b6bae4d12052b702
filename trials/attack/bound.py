"""The least error of temperature that a table can show at all: the Cramer-Rao bound, and what an unknown chamber adds.

Known are the mix up to the parameters of its law, a level of each specimen and a shift that is a polynomial of some
degree; tests scatter, nothing else is wrong. An isotherm that is off shows by what the shift cannot follow. Errors of
the chamber at each isotherm are no part of any law: their standard deviation, known here, adds to all isotherms.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd

from .mixes import LAWS, SHIFTS, Mix
from .power import CAMPAIGNS, THRESHOLD, VERY_CAREFUL, Z_95

SEED = 20290214
MIXES = 12
ENDS = -10.0, 30.0  # degC
ISOTHERMS = 4, 5, 6, 8, 10
SHIFT_PARAMETERS = 2, 3, 4
CHAMBER = 0.0, 0.05, 0.1, 0.2  # K
STEP = 1e-4


def table() -> pd.DataFrame:
    """Size [K] that is named in 19 of 20 tables at an isotherm between others, in the median over mixes and places.

    A column for each standard deviation of the chamber; infinite where a shift of so many parameters follows it all.
    """
    rows = []
    for count, shift in product(ISOTHERMS, SHIFT_PARAMETERS):
        row = {"isotherms": count, "shift_parameters": shift}
        for chamber in CHAMBER:
            limits = np.concatenate([_limits(n, count, shift, chamber) for n in range(MIXES)])
            row[f"chamber_{chamber:g}_K"] = float(np.median(limits))
        rows.append(row)
    return pd.DataFrame(rows)


def _limits(number: int, count: int, shift: int, chamber: float) -> np.ndarray:
    """Of one mix (count - 2,), infinite where the shift follows an isotherm wherever it lies."""
    rng = np.random.default_rng([SEED, number])
    mix = Mix.draw(list(LAWS)[number % len(LAWS)], list(SHIFTS)[number % len(SHIFTS)], rng)
    specimens, modulus, phase = VERY_CAREFUL
    isotherms, band = np.linspace(*ENDS, count), np.array(CAMPAIGNS["EN 12697-26"][2])
    t, f = (np.repeat(isotherms, band.size), np.tile(band, count))
    # One specimen stands for all: a mean of as many tests.
    sigma = np.repeat([np.mean(modulus), np.radians(np.mean(phase))], t.size) / np.sqrt(specimens)
    here = mix.log_modulus(f, t)
    per_time = _both(mix.log_modulus(f, t, STEP) - here) / STEP
    per_kelvin = _both(mix.log_modulus(f, t + STEP) - here) / STEP
    away = (t - isotherms.mean()) / np.ptp(isotherms)
    of_shift = [np.tile(away**power, 2) * per_time for power in range(1, shift + 1)]
    level = np.repeat([1.0, 0.0], t.size)
    nuisance = np.column_stack([*_along_law(mix, f, t), per_time, level, *of_shift])
    at = np.tile(t, 2)[:, None] == isotherms
    kelvin = per_kelvin[:, None] * at
    covariance = np.diag(sigma**2) + chamber**2 * kelvin @ kelvin.T
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    follows = np.linalg.qr(root @ nuisance)[0]
    left = root @ kelvin
    left = left - follows @ (follows.T @ left)
    information = (left**2).sum(axis=0)[1:-1]
    error = np.where(information > 1e-6, 1.0, np.inf) / np.sqrt(np.maximum(information, 1e-6))
    return (THRESHOLD + Z_95) * error


def _both(change: np.ndarray) -> np.ndarray:
    """Of ln|E*|, then of the phase (2n,)."""
    return np.concatenate([change.real, change.imag])


def _along_law(mix: Mix, f: np.ndarray, t: np.ndarray) -> list[np.ndarray]:
    """By each parameter of the law, in relative steps (2n,)."""
    here = mix.log_modulus(f, t)
    found = []
    for name, value in mix.parameters.items():
        moved = Mix(mix.law, mix.parameters | {name: value * (1.0 + STEP)}, mix.shift, mix.constants)
        found.append(_both(moved.log_modulus(f, t) - here) / STEP)
    return found
