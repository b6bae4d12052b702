"""Laws of |E*| alone: the sigmoid of AASHTO R 84 and that of Christensen, Anderson and Marasteanu (CAM).

Causality gives their phase.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from asphalt_nscd.rheology.shift import WLF, Arrhenius

STEP = 1e-5  # of the logarithm of a parameter: central differences err by its square, 1e-10, and by rounding, 1e-11


def _bode(points: int = 32, reach: float = 30.0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Offsets u and weights of 1/pi int s(x + u) ln coth(|u|/2) du, on either side of x.

    u = reach t^4 takes the logarithm at 0 out of reach of Gauss and Legendre; beyond `reach` the weight is e^-30.
    """
    t, w = np.polynomial.legendre.leggauss(points)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    u = reach * t**4
    weight = -w * 4.0 * reach * t**3 * np.log(np.tanh(0.5 * u)) / np.pi
    return np.concatenate([-u[::-1], u]), np.concatenate([weight[::-1], weight])


# These 64 points hold the phase of mixes within 1e-5 deg of that of 800.
OFFSETS, WEIGHTS = _bode()


@dataclass(frozen=True)
class LawOfModulus(ABC):
    """A law of |E*| alone, smooth over ln(frequency): its phase is the one that Kramers and Kronig require.

    phase(x) = 1/pi int s(x + u) ln coth(|u|/2) du, with s = d ln|E*| / dx and x = ln(frequency) (Bode 1945). Where s
    is constant that is 90 deg times s, the approximation of Booij and Thoone (1982).
    """

    static_modulus: float
    glassy_modulus: float
    tau: float
    shift: WLF | Arrhenius

    @abstractmethod
    def log_modulus(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """ln |E*| [ln Pa] at ln(omega tau a_T), of the same shape."""

    @abstractmethod
    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`, d ln|E*| / d ln omega, at ln(omega tau a_T)."""

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""
        x = np.log(np.asarray(omega, dtype=float) * self.tau * self.shift.factor(temperature))
        phase = self.log_slope(np.asarray(x)[..., None] + OFFSETS) @ WEIGHTS
        return np.exp(self.log_modulus(x) + 1j * phase)

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives (n, p) of ln E* by ln of each of `parameters`, by differences; `omega` in rad/s."""
        # differences, since the phase is an integral; the central ones err by STEP^2
        own = [field.name for field in fields(self) if field.name != "shift"]
        columns = []
        for name in own:
            low, high = (
                replace(self, **{name: getattr(self, name) * float(np.exp(step))}).complex_modulus(
                    omega, temperature
                )
                for step in (-STEP, STEP)
            )
            columns.append(np.log(high / low) / (2.0 * STEP))
        # tau and the shift move the same: ln(omega tau a_T)
        columns += list(columns[own.index("tau")] * self.shift.log_slopes(temperature).T)
        return np.column_stack(columns)


@dataclass(frozen=True)
class Sigmoid(LawOfModulus):
    """Sigmoid of AASHTO R 84 and MEPDG, log10|E*| = delta + alpha / (1 + exp(beta + gamma log10 t_r)).

    `static_modulus` is its lower end 10^delta [Pa], `glassy_modulus` its upper end 10^(delta + alpha) [Pa]; at `tau`
    [s], at the reference temperature of `shift`, log|E*| is half-way; `gamma` is the slope, the formula's over ln 10 (R
    84 writes it of f_r, with the other sign).

    >>> law = Sigmoid(100e6, 25e9, tau=0.2, gamma=0.25, shift=WLF(24.0, 160.0, 15.0))
    >>> np.degrees(np.angle(law.complex_modulus(2 * np.pi * 10, [0, 15, 30]))).round(1).tolist()
    [12.7, 27.7, 28.3]
    """

    title: ClassVar[str] = "sigmoid"

    gamma: float

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What the parameters (SI units) must satisfy, in the names of a law file, if they do not; else empty."""
        # Unlike CAM the sigmoid takes the logarithm of its lower end.
        if (
            0.0 < values["static_modulus"] < values["glassy_modulus"]
            and min(values["tau"], values["gamma"]) > 0.0
        ):
            return ""
        return "needs 0 < E_static_Pa < E_glassy_Pa, and tau_s and gamma above zero"

    def log_modulus(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """ln |E*| [ln Pa] at ln(omega tau a_T)."""
        low, high = np.log(self.static_modulus), np.log(self.glassy_modulus)
        return low + (high - low) * expit(self.gamma * log_reduced)

    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`, d ln|E*| / d ln omega, at ln(omega tau a_T)."""
        share = expit(self.gamma * log_reduced)
        return np.log(self.glassy_modulus / self.static_modulus) * self.gamma * share * (1.0 - share)


@dataclass(frozen=True)
class CAM(LawOfModulus):
    """Modified law of Christensen, Anderson and Marasteanu for mixes (Zeng, Bahia, Zhai, Anderson & Turner 2001).

    |E*| = static + (glassy - static) / (1 + (omega tau a_T)^-v)^(w/v); the two moduli, limits at zero and infinite
    frequency, are in Pa. `tau` [s] is the inverse of the crossover frequency at the reference temperature of `shift`,
    `v` the width of the transition, `w` the final slope of ln|E*| over ln(omega).

    >>> law = CAM(100e6, 30e9, tau=0.2, v=0.2, w=0.8, shift=WLF(24.0, 160.0, 15.0))
    >>> np.degrees(np.angle(law.complex_modulus(2 * np.pi * 10, [0, 15, 30]))).round(1).tolist()
    [11.7, 26.5, 37.1]
    """

    title: ClassVar[str] = "CAM"

    v: float
    w: float

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What the parameters (SI units) must satisfy, in the names of a law file, if they do not; else empty."""
        positive = min(values["tau"], values["v"], values["w"]) > 0.0
        if positive and 0.0 <= values["static_modulus"] < values["glassy_modulus"]:
            return ""
        return "needs 0 <= E_static_Pa < E_glassy_Pa, and tau_s, v and w above zero"

    def _parts(self, log_reduced: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """|E*| [Pa] and its derivative by ln(omega) [Pa], at ln(omega tau a_T)."""
        # ln(1 + x^-v) by logaddexp: x^-v overflows at the lowest reduced frequencies
        above = np.exp(-self.w / self.v * np.logaddexp(0.0, -self.v * log_reduced))
        above *= self.glassy_modulus - self.static_modulus
        return self.static_modulus + above, above * self.w * expit(-self.v * log_reduced)

    def log_modulus(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """ln |E*| [ln Pa] at ln(omega tau a_T), of the same shape."""
        return np.log(self._parts(log_reduced)[0])

    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`, d ln|E*| / d ln omega, at ln(omega tau a_T)."""
        modulus, slope = self._parts(log_reduced)
        return slope / modulus
