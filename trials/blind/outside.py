"""Effects that no cause of the catalogue describes: a diagnosis may see them, but must not name them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from .causes import Details, Effect, Place
from .rig import Rig


def _code(design: pd.DataFrame, column: str) -> np.ndarray:
    """Rank of each row's value among the sorted values of a column, from 0."""
    return np.unique(design[column].to_numpy(), return_inverse=True)[1]


def _gain_at_frequency(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.gain = rig.gain + np.log1p(amplitude) * (rig.design["frequency_Hz"] == where).to_numpy()


def _rough_hot_gain(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    """Modulus alone, in the hotter half, growing with temperature and changing sign between isotherms."""
    rank = _code(rig.design, "temperature_C")
    first = (rank.max() + 1) // 2
    growth = np.maximum(rank - first + 1, 0) / (rank.max() - first + 1)
    rig.gain = rig.gain + amplitude * growth * (-1.0) ** rank


def _rig_resonance(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    """A mode of the frame, of small participation, in the force channel."""
    x = rig.design["frequency_Hz"].to_numpy(float) / details["frequency_Hz"]
    rig.transfer = rig.transfer * (1.0 + amplitude * x**2 / (1.0 - x**2 + 2j * details["damping"] * x))


def _resonance_details(design: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    tested = design["frequency_Hz"].unique()
    near = float(rng.choice(tested)) * np.exp(rng.uniform(-0.15, 0.15))
    return {"frequency_Hz": float(near), "damping": float(rng.uniform(0.02, 0.08))}


def _wrong_frequency(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.tuning = rig.tuning * (1.0 + amplitude * (rig.design["frequency_Hz"] == where).to_numpy())


def _alternating_phase(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.gain = rig.gain + 1j * np.radians(amplitude) * (-1.0) ** _code(rig.design, "frequency_Hz")


def _isotherm_phase(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.gain = rig.gain + 1j * np.radians(amplitude) * (rig.design["temperature_C"] == where).to_numpy()


def _modulus_step(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    """The range of the force amplifier changes in the middle of the frequencies."""
    rank = _code(rig.design, "frequency_Hz")
    rig.gain = rig.gain + amplitude * np.where(rank > rank.max() / 2, 0.5, -0.5)


def _specimen_frequency(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    pattern = np.array(details["pattern"])
    rig.gain = (
        rig.gain + amplitude * pattern[_code(rig.design, "specimen"), _code(rig.design, "frequency_Hz")]
    )


def _interaction_details(design: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    """Means of rows and columns removed, so that neither a specimen nor a frequency carries it alone."""
    pattern = rng.standard_normal((design["specimen"].nunique(), design["frequency_Hz"].nunique()))
    pattern -= pattern.mean(axis=0)
    pattern -= pattern.mean(axis=1, keepdims=True)
    return {"pattern": (pattern / pattern.std()).tolist()}


def _specimen_phase(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.gain = rig.gain + 1j * np.radians(amplitude) * (rig.design["specimen"] == where).to_numpy()


OUTSIDE: dict[str, Effect] = {
    "gain_at_frequency": Effect("1", 0.01, _gain_at_frequency, confined="frequency_Hz", signed=True),
    "rough_hot_gain": Effect("1", 0.01, _rough_hot_gain, signed=True, needs="temperature_C"),
    "rig_resonance": Effect("1", 1e-3, _rig_resonance, signed=True, details=_resonance_details),
    "wrong_frequency": Effect("1", 0.03, _wrong_frequency, confined="frequency_Hz", signed=True),
    "alternating_phase": Effect("deg", 0.1, _alternating_phase, signed=True, needs="frequency_Hz"),
    "isotherm_phase": Effect("deg", 0.2, _isotherm_phase, confined="temperature_C", signed=True),
    "modulus_step": Effect("1", 0.01, _modulus_step, signed=True, needs="frequency_Hz"),
    "specimen_frequency": Effect(
        "1", 0.005, _specimen_frequency, needs="specimen", details=_interaction_details
    ),
    "specimen_phase": Effect("deg", 0.2, _specimen_phase, confined="specimen", signed=True),
}
