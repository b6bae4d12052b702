"""Parabolic creep elements in series: the laws of Huet and Sayegh, and 2S2P1D.

Two elements in series with a spring give the law of Huet (1963) and Sayegh (1967); a dashpot in series makes it the
2S2P1D law (Olard & Di Benedetto 2003).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.rheology.shift import WLF, Arrhenius


class _Elements:
    """What both laws share; without a dashpot, in Huet's, its term and its column are absent."""

    static_modulus: float
    glassy_modulus: float
    k: float
    h: float
    delta: float
    tau: float
    shift: WLF | Arrhenius

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What the parameters (SI units) must satisfy, in the names of a law file, if they do not; else empty."""
        positive = all(values[name] > 0.0 for name in ("delta", "tau", "beta") if name in values)
        ordered = 0.0 <= values["static_modulus"] < values["glassy_modulus"]
        # Equal exponents are one element of weight 1 + delta: a law still, though k and h say the same.
        if positive and ordered and 0.0 < values["k"] <= values["h"] < 1.0:
            return ""
        return "needs 0 < k <= h < 1, 0 <= E_static_Pa < E_glassy_Pa, and delta, tau_s and beta above zero"

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""
        reduced = 1j * np.asarray(omega, dtype=float) * self.tau * self.shift.factor(temperature)
        retarded = 1.0 + self.delta * reduced**-self.k + reduced**-self.h
        if isinstance(self, TwoS2P1D):
            retarded = retarded + 1.0 / (reduced * self.beta)
        return self.static_modulus + (self.glassy_modulus - self.static_modulus) / retarded

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives (n, p) of ln E* by ln of each of `parameters`, at `omega` [rad/s] and `temperature` [degC]."""
        omega = np.asarray(omega, dtype=float)
        # powers of i w tau as exponentials: its logarithm is a factor of the derivatives by k and h
        log_reduced = np.log(omega * self.tau * self.shift.factor(temperature)) + 0.5j * np.pi
        slow, fast = self.delta * np.exp(-self.k * log_reduced), np.exp(-self.h * log_reduced)
        flow = (
            np.exp(-log_reduced) / self.beta if isinstance(self, TwoS2P1D) else np.zeros(omega.shape, complex)
        )
        retarded = 1.0 + slow + fast + flow
        glassy, static = self.glassy_modulus, self.static_modulus
        modulus = static + (glassy - static) / retarded
        by_retarded = -(glassy - static) / retarded**2
        by_reduced = -by_retarded * (self.k * slow + self.h * fast + flow)
        # In the order of `parameters`, each times its parameter, as derivatives by logarithms are.
        columns = [
            static * (1.0 - 1.0 / retarded),
            glassy / retarded,
            -by_retarded * slow * log_reduced * self.k,
            -by_retarded * fast * log_reduced * self.h,
            by_retarded * slow,
            by_reduced,
        ]
        if isinstance(self, TwoS2P1D):
            columns.append(-by_retarded * flow)
        columns += list(by_reduced * self.shift.log_slopes(temperature).T)
        return np.asarray(np.column_stack(columns) / modulus[:, None], complex)


@dataclass(frozen=True)
class HuetSayegh(_Elements):
    """Huet-Sayegh law of one mix (Huet 1963, Sayegh 1967).

    E* = E_0 + (E_inf - E_0) / (1 + delta (i w tau)^-k + (i w tau)^-h), w the reduced angular frequency.
    `static_modulus` E_0 and `glassy_modulus` E_inf in Pa; `tau` [s] at the reference temperature of `shift`; exponents
    0 < k <= h < 1.
    """

    title: ClassVar[str] = "Huet-Sayegh"

    static_modulus: float
    glassy_modulus: float
    k: float
    h: float
    delta: float
    tau: float
    shift: WLF | Arrhenius


@dataclass(frozen=True)
class TwoS2P1D(_Elements):
    """2S2P1D law of one mix (Olard & Di Benedetto 2003).

    E* = E_0 + (E_inf - E_0) / (1 + delta (i w tau)^-k + (i w tau)^-h + 1 / (i w beta tau)), w the reduced angular
    frequency. `static_modulus` E_0 and `glassy_modulus` E_inf in Pa; `tau` [s] at the reference temperature of `shift`;
    exponents 0 < k <= h < 1; `beta` is of the dashpot, viscosity = (E_inf - E_0) beta tau.

    >>> law = TwoS2P1D(30e6, 36e9, k=0.2, h=0.58, delta=2.2, tau=0.06, beta=250.0, shift=WLF(24.0, 160.0, 15.0))
    >>> abs(law.complex_modulus(2 * np.pi * 10, [0, 15, 30]) / 1e6).round().tolist()  # MPa
    [23504.0, 11931.0, 3032.0]
    """

    title: ClassVar[str] = "2S2P1D"

    static_modulus: float
    glassy_modulus: float
    k: float
    h: float
    delta: float
    tau: float
    beta: float
    shift: WLF | Arrhenius
