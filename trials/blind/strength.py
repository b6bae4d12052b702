"""How strongly an effect stands out of the scatter: noncentralities that make effects comparable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .laws import REFERENCE, Law

Complex = NDArray[np.complex128]

PER_DECADE = 3  # elements of the spectrum that stands for any smooth law
MARGIN = 1.5  # decades of it beyond the reduced frequencies tested
LOG_WEIGHT_FREEDOM = 1.0  # standard deviation granted to the ln of each element
STATIC_FREEDOM = 1e8  # Pa
SHIFT_FREEDOM = 3.0  # in ln a_T over the range of temperatures, linear and square


@dataclass(frozen=True)
class Scatter:
    """Standard deviations: |E*| and displacement relative, phase in degrees, per test; specimen scale."""

    modulus: float = 0.01
    phase_deg: float = 0.3
    specimen: float = 0.03
    displacement: float = 0.005


def strength(effect: Complex, scatter: Scatter) -> float:
    """sqrt(sum((effect/sigma)^2)) of effect = ln(E* with / E* without), one entry per test."""
    return float(np.linalg.norm(_whitened(effect, scatter)))


def visible_strength(effect: Complex, law: Law, design: pd.DataFrame, scatter: Scatter) -> float:
    """The strength that is left after a smooth spectrum, a smooth shift and specimen scales gave way.

    sqrt(min over p of |(effect - J p)/sigma|^2 + |p|^2) with p in units of its prior standard deviation.
    """
    columns = _nuisance(law, design, scatter)
    jacobian = np.column_stack([_whitened(column, scatter) for column in columns])
    freedoms = jacobian.shape[1]
    target = np.concatenate([_whitened(effect, scatter), np.zeros(freedoms)])
    matrix = np.vstack([jacobian, -np.eye(freedoms)])
    p = np.linalg.lstsq(matrix, target, rcond=None)[0]
    return float(np.linalg.norm(target - matrix @ p))


def amplitude_of(target: float, measure: Callable[[float], float], start: float) -> float:
    """The amplitude, of the sign of `start`, whose strength measure(amplitude) is `target`."""
    amplitude = start
    for _ in range(60):
        found = measure(amplitude)
        if found == 0.0:
            raise ValueError("the effect does not show in this design at any amplitude")
        if abs(found / target - 1.0) < 1e-6:
            return amplitude
        amplitude *= min(max(target / found, 0.1), 10.0)
    raise ArithmeticError(f"no amplitude found with strength {target:g}")


def _whitened(effect: Complex, scatter: Scatter) -> NDArray[np.float64]:
    return np.concatenate([effect.real / scatter.modulus, effect.imag / np.radians(scatter.phase_deg)])


def _nuisance(law: Law, design: pd.DataFrame, scatter: Scatter) -> list[Complex]:
    """Derivatives of ln E* by everything that is not known of a mix and its specimens, times its freedom."""
    temperature = design["temperature_C"].to_numpy(float)
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy(float)
    modulus = law.modulus(omega, temperature)
    reduced = omega * np.exp(law.log_shift(temperature) - law.log_shift(REFERENCE))

    low, high = np.log10(reduced.min()) - MARGIN, np.log10(reduced.max()) + MARGIN
    rates = 10.0 ** np.linspace(low, high, int((high - low) * PER_DECADE) + 2)
    # First-order spectrum (Schapery): the weight of a decade is the rise of E' over it.
    step = np.log(rates[1] / rates[0])
    weight = law.modulus(rates * np.exp(step / 2), REFERENCE).real
    weight = weight - law.modulus(rates * np.exp(-step / 2), REFERENCE).real
    ratio = 1j * reduced[:, None] / rates
    spectrum = LOG_WEIGHT_FREEDOM * weight * ratio / (1.0 + ratio) / modulus[:, None]

    slope = np.log(law.modulus(omega * np.exp(0.01), temperature) / modulus) / 0.01
    above = (temperature - REFERENCE) / max(np.ptp(temperature), 1.0)
    shift = [SHIFT_FREEDOM * slope * above, SHIFT_FREEDOM * slope * above**2]
    specimens = [
        scatter.specimen * (design["specimen"] == name).to_numpy().astype(complex)
        for name in design["specimen"].unique()
    ]
    return [*spectrum.T, STATIC_FREEDOM / modulus, *shift, *specimens]
