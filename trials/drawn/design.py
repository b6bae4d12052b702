"""Designs, and tables of a mix without any fault but scatter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from .laws import draw_law

MODULUS, PHASE_DEG, LEVEL = 0.01, 0.3, 0.03  # standard deviations: of a test, relative and deg; of a specimen


def factorial(
    specimens: Sequence[str] = "ABCD",
    temperatures: Sequence[float] = (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0),
    frequencies: Sequence[float] = (3.0, 6.0, 10.0, 25.0, 40.0),
    **more: Sequence[float],
) -> pd.DataFrame:
    """Every combination as one row: specimen, temperature_C, frequency_Hz, and `more` columns with their levels."""
    levels = {"specimen": list(specimens), "temperature_C": temperatures, "frequency_Hz": frequencies} | more
    return pd.MultiIndex.from_product(levels.values(), names=levels).to_frame(index=False)


def scattered(seed: int, design: pd.DataFrame, shape: str | None = None) -> pd.DataFrame:
    """E_MPa and phase_deg of the tests of a design, of a mix drawn by `draw_law`."""
    law_seed, scatter_seed = np.random.SeedSequence(seed).spawn(2)
    law, rng = draw_law(np.random.default_rng(law_seed), shape), np.random.default_rng(scatter_seed)
    names, code = np.unique(design["specimen"].to_numpy(), return_inverse=True)
    level = LEVEL * rng.standard_normal(names.size)[code]
    modulus, phase = rng.standard_normal((2, len(design)))
    scatter = level + MODULUS * modulus + 1j * np.radians(PHASE_DEG) * phase
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy(float)
    measured = law.modulus(omega, design["temperature_C"].to_numpy(float)) * np.exp(scatter)
    return design.assign(E_MPa=1e-6 * np.abs(measured), phase_deg=np.degrees(np.angle(measured)))
