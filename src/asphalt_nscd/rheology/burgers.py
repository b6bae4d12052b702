"""Burgers law: a Maxwell element in series with a Kelvin-Voigt element, Eqs. (27)-(29)."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.rheology.chain import KelvinChain

# Pa and Pa s: beyond, rates of relaxation leave the digits of a double
PARAMETERS = Range(low=1e-3, high=1e20)


@dataclass(frozen=True)
class Burgers:
    """Macroscopic Burgers law of one temperature, Eqs. (27)-(29).

    Maxwell element: spring `modulus_m` (E_m) [Pa] and dashpot `viscosity_m` (eta_m) [Pa s]; Kelvin-Voigt element:
    spring `modulus_k` (E_k) [Pa] and dashpot `viscosity_k` (eta_k) [Pa s].

    >>> law = Burgers(modulus_m=24.3e9, viscosity_m=3.71e9, modulus_k=48.4e9, viscosity_k=0.773e9)
    >>> modulus = law.complex_modulus(2 * np.pi * 10)
    >>> print(f"{abs(modulus) / 1e9:.2f} GPa, {np.degrees(np.angle(modulus)):.1f} deg")
    18.70 GPa, 15.9 deg
    """

    modulus_m: float
    viscosity_m: float
    modulus_k: float
    viscosity_k: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not PARAMETERS.holds(value):
                raise InputError(
                    f"Burgers law: {field.name} = {value:g} must be {PARAMETERS}; give Pa or Pa s."
                )

    def kelvin_form(self) -> KelvinChain:
        """The same law as a Kelvin chain of one element, without approximation."""
        return KelvinChain(self.modulus_m, self.viscosity_m, (self.modulus_k,), (self.viscosity_k,))

    def complex_compliance(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Complex compliance D* = D' - i D'' [1/Pa] at angular frequencies [rad/s], Eqs. (28)-(29)."""
        i_omega = 1j * np.asarray(omega, dtype=float)
        return (
            1.0 / self.modulus_m
            + 1.0 / (i_omega * self.viscosity_m)
            + 1.0 / (self.modulus_k + i_omega * self.viscosity_k)
        )

    def complex_modulus(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus E* = 1/D* [Pa] at angular frequencies [rad/s], Eq. (27)."""
        return 1.0 / self.complex_compliance(omega)

    def creep_compliance(self, time: ArrayLike) -> NDArray[np.float64]:
        """Strain per unit of constant stress, D(t) [1/Pa], at times after loading [s]."""
        return self.kelvin_form().creep_compliance(time)

    def relaxation_modulus(self, time: ArrayLike) -> NDArray[np.float64]:
        """Stress per unit of constant strain, E(t) [Pa], at times after loading [s].

        Inverse Laplace transform of 1/(s D(s)), D(s) = 1/E_m + 1/(s eta_m) + 1/(E_k + s eta_k): two exponentials whose
        rates are the roots of p2 s^2 - p1 s + 1 (Findley, Lai & Onaran 1976, ch. 5).
        """
        time = np.asarray(time, dtype=float)
        retardation = self.viscosity_k / self.modulus_k
        p1 = self.viscosity_m / self.modulus_m + self.viscosity_m / self.modulus_k + retardation
        p2 = self.viscosity_m / self.modulus_m * retardation
        # Above zero for any four positive parameters, so that both rates are real: the law cannot ring.
        root = np.sqrt(p1**2 - 4.0 * p2)
        slow = 2.0 / (p1 + root)  # not (p1 - root)/(2 p2), which cancels
        fast = (p1 + root) / (2.0 * p2)
        weight_slow = self.viscosity_m * (1.0 - retardation * slow) / root
        weight_fast = self.viscosity_m * (retardation * fast - 1.0) / root
        return weight_slow * np.exp(-slow * time) + weight_fast * np.exp(-fast * time)
