"""Test designs, the specimen's geometry, and the reduction of Eqs. (1)-(3), shared with nothing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

# Trapezoid of the paper, in the keys of a geometry file.
GEOMETRY = {"b_mm": 25.0, "B_mm": 56.0, "e_mm": 25.0, "h_mm": 250.0, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
HEAD_SHARE = 0.135  # of the specimen's mass, Eq. (1)
SECONDS_PER_TEST = 10.0  # the cycles a test leaves behind for the next one


def form_factor(geometry: dict[str, float]) -> float:
    """gamma [1/m], Eq. (3) as printed; needs b < B."""
    b, B, e, h = (1e-3 * geometry[name] for name in ("b_mm", "B_mm", "e_mm", "h_mm"))
    bracket = (2.0 - b / (2.0 * B)) * b / B - 1.5 - np.log(b / B)
    return float(12.0 * h**3 / (e * (B - b) ** 3) * bracket)


def head_mass(geometry: dict[str, float]) -> float:
    """Share of the specimen's mass that moves with the head [kg]."""
    return HEAD_SHARE * geometry["mass_kg"]


def apparent_modulus(geometry: dict[str, float], frequency: ArrayLike, stiffness: ArrayLike) -> np.ndarray:
    """E* [Pa] from the complex head stiffness F/z [N/m] at frequency [Hz], Eqs. (1)-(2)."""
    inertia = (head_mass(geometry) + geometry["mobile_mass_kg"]) * (2.0 * np.pi * np.asarray(frequency)) ** 2
    return form_factor(geometry) * (np.asarray(stiffness) + inertia)


def head_stiffness(geometry: dict[str, float], frequency: ArrayLike, modulus: ArrayLike) -> np.ndarray:
    """The complex F/z [N/m] that Eqs. (1)-(2) reduce to `modulus` [Pa] at frequency [Hz]."""
    inertia = (head_mass(geometry) + geometry["mobile_mass_kg"]) * (2.0 * np.pi * np.asarray(frequency)) ** 2
    return np.asarray(modulus) / form_factor(geometry) - inertia


def factorial(
    specimens: Sequence[str] = "ABCD",
    temperatures: Sequence[float] = (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0),
    frequencies: Sequence[float] = (3.0, 6.0, 10.0, 25.0, 40.0),
    amplitudes: Sequence[float] = (63e-6,),
    replicates: int = 1,
    order: str | None = None,
    seed: int = 0,
) -> pd.DataFrame:
    """Every combination as one row: specimen, temperature_C, frequency_Hz, amplitude_m (head, [m]).

    replicates > 1 adds `replicate`. order ("cold_first" or "shuffled", by `seed`) adds `order`, from 1
    within each specimen, and `cycles`, the load cycles the specimen bore before the test.
    """
    levels = [
        list(specimens),
        list(temperatures),
        list(frequencies),
        list(amplitudes),
        range(1, replicates + 1),
    ]
    names = ["specimen", "temperature_C", "frequency_Hz", "amplitude_m", "replicate"]
    design = pd.MultiIndex.from_product(levels, names=names).to_frame(index=False)
    if replicates == 1:
        design = design.drop(columns="replicate")
    if order is not None:
        design = _ordered(design, order, np.random.default_rng(seed))
    return design


def _ordered(design: pd.DataFrame, order: str, rng: np.random.Generator) -> pd.DataFrame:
    parts = []
    for _, part in design.groupby("specimen", sort=False):
        if order == "shuffled":
            part = part.iloc[rng.permutation(len(part))]
        elif order == "cold_first":
            part = part.sort_values(["temperature_C", "frequency_Hz"], kind="stable")
        else:
            raise ValueError(f"order {order!r}: 'cold_first' or 'shuffled'")
        borne = (SECONDS_PER_TEST * part["frequency_Hz"]).cumsum().shift(fill_value=0.0)
        parts.append(part.assign(order=np.arange(1, len(part) + 1), cycles=borne.round().astype(int)))
    return pd.concat(parts, ignore_index=True)
