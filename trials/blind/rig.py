"""What stands between the specimen's law and the recorded ratio of force to displacement.

specimen (temperature, extra branch, factors) -> its share of mass -> clamp -> moving mass, guide spring,
guide slider -> channels (delay, offset, transfer) -> reduction -> what only the table shows (gain).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .design import apparent_modulus, form_factor, head_mass, head_stiffness
from .laws import Law

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
Branch = Callable[[Vector, Vector], Complex]  # (omega [rad/s], temperature [degC]) -> modulus [Pa]

HEATING_PASSES = 200  # at most; a few suffice unless the temperature rise is large
HEATING_TOLERANCE = 1e-9  # K


@dataclass
class Rig:
    """State of every test, one entry per row of the design; the default is a perfect rig."""

    design: pd.DataFrame
    warming: Vector = field(init=False)  # K, specimen warmer than its label
    heating: float = 0.0  # K at the test with the most dissipation
    branches: list[Branch] = field(default_factory=list)
    factor: Complex = field(init=False)  # on the specimen's modulus
    compliance: Vector = field(init=False)  # m/N, between the head and the moving equipment
    mass: float = 0.0  # kg, unknown to the reduction
    spring: float = 0.0  # N/m, head to ground
    slider: float = 0.0  # N, head to ground
    delay: float = 0.0  # s, displacement channel behind the force channel
    offset: Vector = field(init=False)  # rad, by which the measured force leads too far
    transfer: Complex = field(init=False)  # on the measured ratio F/z
    gain: Complex = field(init=False)  # ln of a factor on the reduced modulus
    tuning: Vector = field(init=False)  # true frequency over the one in the table

    def __post_init__(self) -> None:
        n = len(self.design)
        self.warming, self.compliance, self.offset = np.zeros(n), np.zeros(n), np.zeros(n)
        self.factor, self.transfer = np.ones(n, complex), np.ones(n, complex)
        self.gain, self.tuning = np.zeros(n, complex), np.ones(n)


@dataclass(frozen=True)
class Response:
    """What the rig would show without noise."""

    modulus: Complex  # Pa, as Eqs. (1)-(3) give it from peaks at the labelled frequency
    frequency: Vector  # Hz, true
    ratio: Complex  # N/m, measured F/z, first harmonic
    channel: Vector  # rad, part of the angle of `ratio` due to the displacement channel
    sliding: Complex  # N/m, part of the ratio of F/z at the head due to the slider


def respond(law: Law, rig: Rig, geometry: dict[str, float], amplitude: Vector | None = None) -> Response:
    """amplitude [m]: head displacement per row, that of the design unless given."""
    design = rig.design
    label = design["frequency_Hz"].to_numpy(float)
    z0 = design["amplitude_m"].to_numpy(float) if amplitude is None else amplitude
    frequency = label * rig.tuning
    omega = 2.0 * np.pi * frequency
    specimen = _material(law, rig, omega) * rig.factor
    head = specimen / form_factor(geometry) - head_mass(geometry) * omega**2
    head = head / (1.0 + rig.compliance * head)
    sliding = 4j * rig.slider / (np.pi * z0)
    head = head - (geometry["mobile_mass_kg"] + rig.mass) * omega**2 + rig.spring + sliding
    channel = omega * rig.delay + rig.offset
    modulus = apparent_modulus(geometry, label, head * np.exp(1j * channel) * rig.transfer)
    modulus = modulus * np.exp(rig.gain)
    return Response(modulus, frequency, head_stiffness(geometry, label, modulus), channel, sliding)


def _material(law: Law, rig: Rig, omega: Vector) -> Complex:
    def modulus(_: Vector, temperature: Vector) -> Complex:
        return law.modulus(omega, temperature) + sum(branch(omega, temperature) for branch in rig.branches)

    return modulus(omega, warmed(modulus, rig, omega))


def warmed(modulus: Branch, rig: Rig, omega: Vector) -> Vector:
    """True temperature (n,) [degC] of each test, of specimens with E* = modulus(omega, temperature)."""
    label = rig.design["temperature_C"].to_numpy(float)
    strain = (rig.design["amplitude_m"] / rig.design["amplitude_m"].max()).to_numpy(float)
    warming = rig.warming
    if rig.heating == 0.0:
        return label + warming
    # Each test warms by its own dissipation, which depends on how warm it is.
    for _ in range(HEATING_PASSES):
        power = omega * modulus(omega, label + warming).imag * strain**2
        last, warming = warming, rig.warming + rig.heating * power / power.max()
        if np.abs(warming - last).max() < HEATING_TOLERANCE:
            return label + warming
    raise ArithmeticError(f"self-heating of {rig.heating:g} K does not settle")
