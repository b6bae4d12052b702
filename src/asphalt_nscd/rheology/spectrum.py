"""Continuous spectra: laws smooth over all frequencies, carried to all temperatures by a shift.

Two parabolic creep elements in series with a spring give the law of Huet (1963) and Sayegh (1967);
a dashpot in series makes it the 2S2P1D law (Olard & Di Benedetto 2003). Two more are laws of |E*| alone: the
sigmoid of AASHTO R 84 and that of Christensen, Anderson and Marasteanu (CAM); causality gives their phase.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from asphalt_nscd.rheology.shift import WLF, Arrhenius

STEP = 1e-5  # of the logarithm of a parameter, for derivatives by differences


def _bode(points: int = 32, reach: float = 30.0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Offsets u and weights of 1/pi int s(x + u) ln coth(|u|/2) du, on either side of x.

    u = reach t^4 takes the logarithm at 0 out of reach of Gauss and Legendre; beyond `reach` the weight is e^-30.
    """
    # u = reach t^4 crowds points about u = 0, where ln coth(|u|/2) is singular but integrable
    t, w = np.polynomial.legendre.leggauss(points)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    u = reach * t**4
    weight = -w * 4.0 * reach * t**3 * np.log(np.tanh(0.5 * u)) / np.pi
    return np.concatenate([-u[::-1], u]), np.concatenate([weight[::-1], weight])


OFFSETS, WEIGHTS = _bode()


class Spectrum(Protocol):
    """A law of all temperatures and frequencies."""

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What the law's own parameters must satisfy, if these do not.

        Parameters
        ----------
        values : mapping of str to float
            Parameters by name, in SI units.

        Returns
        -------
        str
            "needs 0 < k < 1", or nothing.
        """

    title: ClassVar[str]  # as a reader knows it

    @property
    def shift(self) -> WLF | Arrhenius:
        """How frequency and temperature stand for each other."""

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        omega : array_like
            Angular frequencies [rad/s].
        temperature : array_like
            [degC], broadcast with omega.

        Returns
        -------
        ndarray of complex
            E* [Pa], of the shape of both together.
        """

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives of ln E* with respect to the logarithm of each of its `parameters`.

        Parameters
        ----------
        omega : array_like (n,)
            Angular frequencies [rad/s].
        temperature : array_like (n,)
            [degC].

        Returns
        -------
        ndarray of complex
            (n, p) In the order of `parameters`.
        """


@dataclass(frozen=True)
class HuetSayegh:
    """Huet-Sayegh law of one mix (Huet 1963, Sayegh 1967).

    E* = E_0 + (E_inf - E_0) / (1 + delta (i w tau)^-k + (i w tau)^-h), w the reduced angular frequency.

    Parameters
    ----------
    static_modulus : float
        E_0, limit of E* at zero frequency [Pa].
    glassy_modulus : float
        E_inf, limit of E* at infinite frequency [Pa].
    k, h : float
        Exponents of the parabolic elements, 0 < k <= h < 1.
    delta : float
        Weight of the element of exponent k.
    tau : float
        Characteristic time [s] at the reference temperature of the shift.
    shift : WLF or Arrhenius
        Of frequency with temperature.
    """

    title: ClassVar[str] = "Huet-Sayegh"

    static_modulus: float
    glassy_modulus: float
    k: float
    h: float
    delta: float
    tau: float
    shift: WLF | Arrhenius

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What its own parameters must satisfy, if these do not."""
        return _refusal(values)

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        omega : array_like
            Angular frequencies [rad/s].
        temperature : array_like
            [degC], broadcast with omega.

        Returns
        -------
        ndarray of complex
            E* [Pa], of the shape of both together.
        """
        reduced = 1j * np.asarray(omega, dtype=float) * self.tau * self.shift.factor(temperature)
        retarded = 1.0 + self.delta * reduced**-self.k + reduced**-self.h
        return self.static_modulus + (self.glassy_modulus - self.static_modulus) / retarded

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives of ln E* with respect to the logarithm of each of its `parameters`.

        Parameters
        ----------
        omega : array_like (n,)
            Angular frequencies [rad/s].
        temperature : array_like (n,)
            [degC].

        Returns
        -------
        ndarray of complex (n, p)
            In the order of `parameters`.
        """
        return _log_slopes(self, omega, temperature)


@dataclass(frozen=True)
class TwoS2P1D:
    """2S2P1D law of one mix (Olard & Di Benedetto 2003).

    E* = E_0 + (E_inf - E_0) / (1 + delta (i w tau)^-k + (i w tau)^-h + 1 / (i w beta tau)), w the reduced
    angular frequency.

    Parameters
    ----------
    static_modulus : float
        E_0, limit of E* at zero frequency [Pa].
    glassy_modulus : float
        E_inf, limit of E* at infinite frequency [Pa].
    k, h : float
        Exponents of the parabolic elements, 0 < k <= h < 1.
    delta : float
        Weight of the element of exponent k.
    tau : float
        Characteristic time [s] at the reference temperature of the shift.
    beta : float
        Of the dashpot, viscosity = (E_inf - E_0) beta tau.
    shift : WLF or Arrhenius
        Of frequency with temperature.

    Examples
    --------
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

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What its own parameters must satisfy, if these do not."""
        return _refusal(values)

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        omega : array_like
            Angular frequencies [rad/s].
        temperature : array_like
            [degC], broadcast with omega.

        Returns
        -------
        ndarray of complex
            E* [Pa], of the shape of both together.
        """
        reduced = 1j * np.asarray(omega, dtype=float) * self.tau * self.shift.factor(temperature)
        retarded = 1.0 + self.delta * reduced**-self.k + reduced**-self.h + 1.0 / (reduced * self.beta)
        return self.static_modulus + (self.glassy_modulus - self.static_modulus) / retarded

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives of ln E* with respect to the logarithm of each of its `parameters`.

        Parameters
        ----------
        omega : array_like (n,)
            Angular frequencies [rad/s].
        temperature : array_like (n,)
            [degC].

        Returns
        -------
        ndarray of complex
            (n, p) In the order of `parameters`.
        """
        return _log_slopes(self, omega, temperature)


def _refusal(values: Mapping[str, float]) -> str:
    positive = all(values[name] > 0.0 for name in ("delta", "tau", "beta") if name in values)
    ordered = 0.0 <= values["static_modulus"] < values["glassy_modulus"]
    if positive and ordered and 0.0 < values["k"] <= values["h"] < 1.0:
        return ""
    return "needs 0 < k <= h < 1, 0 <= E_static_Pa < E_glassy_Pa, and delta, tau_s and beta above zero"


def _log_slopes(law: HuetSayegh | TwoS2P1D, omega: ArrayLike, temperature: ArrayLike) -> NDArray:
    """Of the law of three terms in series; without a dashpot its term and its column are absent."""
    omega = np.asarray(omega, dtype=float)
    log_reduced = np.log(omega * law.tau * law.shift.factor(temperature)) + 0.5j * np.pi
    slow, fast = law.delta * np.exp(-law.k * log_reduced), np.exp(-law.h * log_reduced)
    flow = np.exp(-log_reduced) / law.beta if isinstance(law, TwoS2P1D) else np.zeros(omega.shape, complex)
    retarded = 1.0 + slow + fast + flow
    glassy, static = law.glassy_modulus, law.static_modulus
    modulus = static + (glassy - static) / retarded
    by_retarded = -(glassy - static) / retarded**2
    by_reduced = -by_retarded * (law.k * slow + law.h * fast + flow)
    columns = [
        static * (1.0 - 1.0 / retarded),
        glassy / retarded,
        -by_retarded * slow * log_reduced * law.k,
        -by_retarded * fast * log_reduced * law.h,
        by_retarded * slow,
        by_reduced,
    ]
    if isinstance(law, TwoS2P1D):
        columns.append(-by_retarded * flow)
    columns += list(by_reduced * law.shift.log_slopes(temperature).T)
    return np.column_stack(columns) / modulus[:, None]


@dataclass(frozen=True)
class OfModulus(ABC):
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
        """ln |E*|.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            [ln Pa], of the same shape.
        """

    @abstractmethod
    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            d ln|E*| / d ln omega, of the same shape.
        """

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        omega : array_like
            Angular frequencies [rad/s].
        temperature : array_like
            [degC], broadcast with omega.

        Returns
        -------
        ndarray of complex
            E* [Pa], of the shape of both together.
        """
        x = np.log(np.asarray(omega, dtype=float) * self.tau * self.shift.factor(temperature))
        phase = self.log_slope(np.asarray(x)[..., None] + OFFSETS) @ WEIGHTS
        return np.exp(self.log_modulus(x) + 1j * phase)

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives of ln E* with respect to the logarithm of each of its `parameters`, by differences.

        Parameters
        ----------
        omega : array_like (n,)
            Angular frequencies [rad/s].
        temperature : array_like (n,)
            [degC].

        Returns
        -------
        ndarray of complex (n, p)
            In the order of `parameters`.
        """
        # differences, since the phase is an integral; the central ones err by STEP^2
        own = parameter_names(type(self))
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
class Sigmoid(OfModulus):
    """Sigmoid of AASHTO R 84 and MEPDG, log10|E*| = delta + alpha / (1 + exp(beta + gamma log10 t_r)).

    Parameters
    ----------
    static_modulus : float
        Its lower end 10^delta [Pa].
    glassy_modulus : float
        Its upper end 10^(delta + alpha) [Pa].
    tau : float
        Where log|E*| is half-way [s], at the reference temperature of the shift.
    shift : WLF or Arrhenius
        Of frequency with temperature.
    gamma : float
        Slope, -R 84's over ln 10.

    Examples
    --------
    >>> law = Sigmoid(100e6, 25e9, tau=0.2, gamma=0.25, shift=WLF(24.0, 160.0, 15.0))
    >>> np.degrees(np.angle(law.complex_modulus(2 * np.pi * 10, [0, 15, 30]))).round(1).tolist()
    [12.7, 27.7, 28.3]
    """

    title: ClassVar[str] = "sigmoid"

    gamma: float

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What its own parameters must satisfy, if these do not."""
        if (
            0.0 < values["static_modulus"] < values["glassy_modulus"]
            and min(values["tau"], values["gamma"]) > 0.0
        ):
            return ""
        return "needs 0 < E_static_Pa < E_glassy_Pa, and tau_s and gamma above zero"

    def log_modulus(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """ln |E*|.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            [ln Pa].
        """
        low, high = np.log(self.static_modulus), np.log(self.glassy_modulus)
        return low + (high - low) * expit(self.gamma * log_reduced)

    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            d ln|E*| / d ln omega.
        """
        share = expit(self.gamma * log_reduced)
        return np.log(self.glassy_modulus / self.static_modulus) * self.gamma * share * (1.0 - share)


@dataclass(frozen=True)
class CAM(OfModulus):
    """Modified law of Christensen, Anderson and Marasteanu for mixes (Zeng, Bahia, Zhai, Anderson & Turner
    2001).

    |E*| = static + (glassy - static) / (1 + (omega tau a_T)^-v)^(w/v).

    Parameters
    ----------
    static_modulus : float
        Limit at zero frequency [Pa].
    glassy_modulus : float
        Limit at infinite frequency [Pa].
    tau : float
        Inverse of the crossover frequency [s], at the reference temperature of the shift.
    shift : WLF or Arrhenius
        Of frequency with temperature.
    v : float
        Width of the transition.
    w : float
        Final slope of ln|E*| over ln(omega).

    Examples
    --------
    >>> law = CAM(100e6, 30e9, tau=0.2, v=0.2, w=0.8, shift=WLF(24.0, 160.0, 15.0))
    >>> np.degrees(np.angle(law.complex_modulus(2 * np.pi * 10, [0, 15, 30]))).round(1).tolist()
    [11.7, 26.5, 37.1]
    """

    title: ClassVar[str] = "CAM"

    v: float
    w: float

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What its own parameters must satisfy, if these do not."""
        positive = min(values["tau"], values["v"], values["w"]) > 0.0
        if positive and 0.0 <= values["static_modulus"] < values["glassy_modulus"]:
            return ""
        return "needs 0 <= E_static_Pa < E_glassy_Pa, and tau_s, v and w above zero"

    def _parts(self, log_reduced: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """|E*| [Pa] and its derivative."""
        # ln(1 + x^-v) by logaddexp: x^-v overflows at the lowest reduced frequencies
        above = np.exp(-self.w / self.v * np.logaddexp(0.0, -self.v * log_reduced))
        above *= self.glassy_modulus - self.static_modulus
        return self.static_modulus + above, above * self.w * expit(-self.v * log_reduced)

    def log_modulus(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """ln |E*|.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            [ln Pa], of the same shape.
        """
        return np.log(self._parts(log_reduced)[0])

    def log_slope(self, log_reduced: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `log_modulus`.

        Parameters
        ----------
        log_reduced : ndarray
            ln(omega tau a_T).

        Returns
        -------
        ndarray
            d ln|E*| / d ln omega, of the same shape.
        """
        modulus, slope = self._parts(log_reduced)
        return slope / modulus


LAWS: dict[str, Any] = {"2s2p1d": TwoS2P1D, "huet-sayegh": HuetSayegh, "sigmoid": Sigmoid, "cam": CAM}


def parameter_names(kind: type) -> list[str]:
    """Names of a law's or a shift's own parameters; the reference temperature is a choice, none of them.

    Parameters
    ----------
    kind : type
        Class of the law or of the shift.

    Returns
    -------
    list of str
        In the order of its fields.
    """
    return [field.name for field in fields(kind) if field.name not in ("shift", "reference_temperature")]


def parameters(law: Any) -> dict[str, float]:
    """Parameters of a law by name, those of its shift, if it has one, at the end.

    Parameters
    ----------
    law : Spectrum
        In SI units.

    Returns
    -------
    dict of str to float
        In the order of `parameter_names`.
    """
    parts = [law, law.shift] if hasattr(law, "shift") else [law]
    return {name: getattr(part, name) for part in parts for name in parameter_names(type(part))}
