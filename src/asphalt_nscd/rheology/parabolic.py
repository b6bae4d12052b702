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
        """What its own parameters must satisfy, if these do not.

        Parameters
        ----------
        values : mapping of str to float
            Parameters by field name: moduli [Pa], tau [s], delta, k and h [-].

        Returns
        -------
        str
            Empty where they are allowed; else what is needed, in the names that a law file has.
        """
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
        """What its own parameters must satisfy, if these do not.

        Parameters
        ----------
        values : mapping of str to float
            Parameters by field name: moduli [Pa], tau [s], delta, k, h and beta [-].

        Returns
        -------
        str
            Empty where they are allowed; else what is needed, in the names that a law file has.
        """
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
    # Equal exponents are one element of weight 1 + delta: a law still, though k and h say the same.
    if positive and ordered and 0.0 < values["k"] <= values["h"] < 1.0:
        return ""
    return "needs 0 < k <= h < 1, 0 <= E_static_Pa < E_glassy_Pa, and delta, tau_s and beta above zero"


def _log_slopes(law: HuetSayegh | TwoS2P1D, omega: ArrayLike, temperature: ArrayLike) -> NDArray:
    """Of the law of three terms in series; without a dashpot its term and its column are absent."""
    omega = np.asarray(omega, dtype=float)
    # powers of i w tau as exponentials: its logarithm is a factor of the derivatives by k and h
    log_reduced = np.log(omega * law.tau * law.shift.factor(temperature)) + 0.5j * np.pi
    slow, fast = law.delta * np.exp(-law.k * log_reduced), np.exp(-law.h * log_reduced)
    flow = np.exp(-log_reduced) / law.beta if isinstance(law, TwoS2P1D) else np.zeros(omega.shape, complex)
    retarded = 1.0 + slow + fast + flow
    glassy, static = law.glassy_modulus, law.static_modulus
    modulus = static + (glassy - static) / retarded
    by_retarded = -(glassy - static) / retarded**2
    by_reduced = -by_retarded * (law.k * slow + law.h * fast + flow)
    # In the order of `parameters`, each times its parameter, as derivatives by logarithms are.
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
