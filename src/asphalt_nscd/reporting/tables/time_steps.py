"""Up to which time step each scheme is right, and what a step of it costs: Fig. 6 and the claim behind it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy import sparse

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.collect import collect
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.rheology.laws_io import read_bond_law

SOLVED, SWEPT, EXPLICIT = "solved", "Gauss-Seidel", "explicit (DEM)"
RIGHT = 0.01  # of ln E*: 1 % of |E*|, 0.6 deg
ITERATIONS = 60  # of the power method


def make(
    solved: list[Path], part: list[Path], stopped: list[Path], law: list[Path], model: list[Path]
) -> pd.DataFrame:
    """One row for each scheme, tolerance and time step: |E*| over that of the solution, and the phase less its own.

    solved: tests of a sample, each step solved; stopped: of a smaller specimen, by Gauss-Seidel until a sweep changes
    the reactions by less than a tolerance; part: the same specimen, solved. The solution of
    `solved` is that of its shortest step. Behind them two rows without a test: the longest step at which implicit Euler
    is right, from the law alone; and the longest at which explicit steps of the sample in `model` are stable, whose
    bonds then have the stiffness Em. right: within RIGHT of ln E*.
    """
    whole, true = collect(solved), collect(part).iloc[0]
    swept = collect(stopped)
    finest = whole.loc[whole["time_step_s"].idxmin()]
    rows = [_row(SOLVED, np.nan, one, finest) for _, one in whole.iterrows()]
    rows += [_row(SWEPT, one["tolerance"], one, true) for _, one in swept.iterrows()]
    bonds = bond_law(read_bond_law(only_file(law, "law")))
    frequency = float(whole["frequency_Hz"].iloc[0])
    rows.append({"scheme": f"{SOLVED}, longest", "time_step_s": longest_step(bonds, 2.0 * np.pi * frequency)})
    system = read_model(only_file(model, "model")).system
    rows.append({"scheme": f"{EXPLICIT}, longest", "time_step_s": explicit_step(system, bonds.spring)})
    return pd.DataFrame(rows)


def _row(scheme: str, tolerance: float, test: pd.Series, solution: pd.Series) -> dict[str, object]:
    """A row of the table: a test by a scheme beside its solution."""
    ratio, apart = test["E_MPa"] / solution["E_MPa"], test["phase_deg"] - solution["phase_deg"]
    return {
        "scheme": scheme,
        "tolerance": tolerance,
        "time_step_s": test["time_step_s"],
        "frequency_Hz": test["frequency_Hz"],
        "spheres": test["spheres"],
        "sweeps_per_step": test["sweeps"] / test["steps"] if "sweeps" in test else np.nan,
        "E_over_solution": ratio,
        "phase_difference_deg": apart,
        "right": bool(np.hypot(np.log(ratio), np.radians(apart)) < RIGHT),
    }


def longest_step(law: BondLaw, omega: float) -> float:
    """Time step [s], to 1 %, above which implicit Euler misses E* at omega [rad/s] by more than RIGHT.

    >>> stiff = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))
    >>> print(f"{1e3 * longest_step(stiff, 2 * np.pi * 3):.1f} ms")
    6.6 ms
    """
    steps = np.geomspace(1e-6, 0.5, 2000) * 2.0 * np.pi / omega
    exact = law.discrete_modulus(omega, 0.0)
    wrong = (step for step in steps if abs(np.log(law.discrete_modulus(omega, step) / exact)) > RIGHT)
    return float(next(wrong))


def explicit_step(system: BondedSystem, modulus: float) -> float:
    """Step [s] beyond which central differences diverge, 2 over the highest frequency; bonds of one modulus [Pa]."""
    # The head is driven, so it swings with no frequency of its own.
    free = np.delete(np.arange(system.mass.size), system.driven)
    scaled = system.operator[:, free] @ sparse.diags_array(system.mass[free] ** -0.5)
    weight = modulus * system.weight
    vector = np.random.default_rng(0).standard_normal(free.size)
    highest = 0.0
    for _ in range(ITERATIONS):
        vector /= np.linalg.norm(vector)
        image = scaled.T @ (weight * (scaled @ vector))
        # Rayleigh's quotient, whose error is the square of the vector's.
        highest = float(vector @ image)
        vector = image
    return float(2.0 / np.sqrt(highest))
