"""The causes a diagnosis may name, as they act on the rig. Names are those of its catalogue."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from .design import form_factor
from .laws import GAS_CONSTANT, KELVIN
from .rig import Rig

Place = Any  # the specimen, temperature or frequency an effect is confined to, or None
Details = Mapping[str, Any]


def _no_details(design: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    return {}


def _same_unit(amplitude: float, design: pd.DataFrame, geometry: dict[str, float]) -> dict[str, float]:
    return {}


@dataclass(frozen=True)
class Effect:
    """One way a rig, a specimen or a mix departs from the model.

    unit: of the amplitude; step: an amplitude of the order of what can be detected; act(rig, amplitude,
    where, details) changes the rig; confined: the column of the design whose one value is hit; signed:
    both signs are physical; needs: column that must vary; others(amplitude, design, geometry): the
    amplitude in other units.
    """

    unit: str
    step: float
    act: Callable[[Rig, float, Place, Details], None]
    confined: str | None = None
    signed: bool = False
    needs: str | None = None
    details: Callable[[pd.DataFrame, np.random.Generator], dict[str, Any]] = _no_details
    others: Callable[[float, pd.DataFrame, dict[str, float]], dict[str, float]] = _same_unit


def _channel_delay(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.delay += amplitude


def _phase_offset(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.offset = rig.offset + np.radians(amplitude)


def _moving_mass(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.mass += amplitude


def _temperature_bias(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.warming = rig.warming + amplitude * (rig.design["temperature_C"] == where).to_numpy()


def _self_heating(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.heating += amplitude


def _guide_stiffness(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.spring += amplitude


def _guide_friction(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.slider += amplitude


def _loose_clamp(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.compliance = rig.compliance + amplitude * (rig.design["specimen"] == where).to_numpy()


def _specimen_geometry(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.factor = rig.factor * (1.0 + amplitude * (rig.design["specimen"] == where).to_numpy())


def _strain_softening(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    rig.factor = rig.factor * (1.0 - amplitude * rig.design["amplitude_m"].to_numpy(float))


def _damage(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    age = rig.design["cycles"].to_numpy(float) / rig.design["cycles"].max()
    rig.factor = rig.factor * (1.0 - amplitude * age)


def _secondary_process(rig: Rig, amplitude: float, where: Place, details: Details) -> None:
    """A Cole-Cole branch in parallel, beside the law and outside its shift."""

    def branch(omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        inverse = 1.0 / (KELVIN + temperature) - 1.0 / (KELVIN + details["centre_C"])
        tau = np.exp(details["energy_J_mol"] / GAS_CONSTANT * inverse) / (2.0 * np.pi * details["centre_Hz"])
        s = (1j * omega * tau) ** details["exponent"]
        return amplitude * s / (1.0 + s)

    rig.branches.append(branch)


def _secondary_details(design: pd.DataFrame, rng: np.random.Generator) -> dict[str, float]:
    """The bump's peak crosses the tested band at a tested temperature; broad, as secondary processes are."""
    t, f = design["temperature_C"], design["frequency_Hz"]
    return {
        "centre_C": float(rng.uniform(*np.quantile(t, [0.2, 0.8]))),
        "centre_Hz": float(np.exp(rng.uniform(*np.log([f.min(), f.max()])))),
        "energy_J_mol": float(rng.uniform(40e3, 90e3)),
        "exponent": float(rng.uniform(0.4, 0.8)),
    }


def _pascals(value: float) -> dict[str, float]:
    return {"Pa": value, "MPa": value * 1e-6, "GPa": value * 1e-9}


def _clamp_units(a: float, design: pd.DataFrame, geometry: dict[str, float]) -> dict[str, float]:
    per_pascal = a / form_factor(geometry)
    return {"1/Pa": per_pascal, "1/MPa": per_pascal * 1e6, "1/GPa": per_pascal * 1e9}


def _friction_units(a: float, design: pd.DataFrame, geometry: dict[str, float]) -> dict[str, float]:
    return _pascals(form_factor(geometry) * 4.0 * a / (np.pi * float(design["amplitude_m"].median())))


def _percent(a: float, design: pd.DataFrame, geometry: dict[str, float]) -> dict[str, float]:
    return {"%": 100.0 * a}


def _softening_units(a: float, design: pd.DataFrame, geometry: dict[str, float]) -> dict[str, float]:
    at_largest = a * float(design["amplitude_m"].max())
    return {"1": at_largest, "%": 100.0 * at_largest, "1/um": 1e-6 * a}


CATALOGUE: dict[str, Effect] = {
    "channel_delay": Effect(
        "s", 3e-5, _channel_delay, signed=True, others=lambda a, d, g: {"ms": 1e3 * a, "us": 1e6 * a}
    ),
    "phase_offset": Effect(
        "deg", 0.3, _phase_offset, signed=True, others=lambda a, d, g: {"rad": float(np.radians(a))}
    ),
    "moving_mass": Effect("kg", 0.05, _moving_mass, signed=True, others=lambda a, d, g: {"g": 1e3 * a}),
    "temperature_bias": Effect(
        "K", 0.3, _temperature_bias, confined="temperature_C", signed=True, others=lambda a, d, g: {"degC": a}
    ),
    "self_heating": Effect("K", 0.3, _self_heating, others=lambda a, d, g: {"degC": a}),
    "guide_stiffness": Effect(
        "N/m", 4e3, _guide_stiffness, others=lambda a, d, g: _pascals(form_factor(g) * a)
    ),
    "guide_friction": Effect("N", 0.1, _guide_friction, others=_friction_units),
    "loose_clamp": Effect("m/N", 2e-8, _loose_clamp, confined="specimen", others=_clamp_units),
    "specimen_geometry": Effect(
        "1", 0.1, _specimen_geometry, confined="specimen", signed=True, others=_percent
    ),
    "strain_softening": Effect("1/m", 200.0, _strain_softening, needs="amplitude_m", others=_softening_units),
    "damage": Effect("1", 0.02, _damage, needs="cycles", others=_percent),
    "secondary_process": Effect(
        "Pa",
        3e8,
        _secondary_process,
        details=_secondary_details,
        others=lambda a, d, g: {"MPa": 1e-6 * a, "GPa": 1e-9 * a},
    ),
}
