"""Kelvin chain (generalised Burgers law): a spring, a dashpot and Kelvin-Voigt elements in series."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.errors import InputError


@dataclass(frozen=True)
class KelvinChain:
    """Law of one temperature: a spring, a dashpot and Kelvin-Voigt elements in series.

    `spring` [Pa] and `dashpot` [Pa s] are infinite where the chain has none; `kelvin_springs` (m,) in Pa,
    `kelvin_dashpots` (m,) in Pa s.

    >>> complex(KelvinChain(10e9, np.inf, (), ()).complex_modulus(2 * np.pi * 10))
    (10000000000+0j)
    """

    spring: float
    dashpot: float
    kelvin_springs: tuple[float, ...]
    kelvin_dashpots: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.kelvin_springs) != len(self.kelvin_dashpots):
            raise InputError(
                f"Kelvin chain: {len(self.kelvin_springs)} springs and {len(self.kelvin_dashpots)} dashpots; "
                "give one of each for every element."
            )
        elements = (*self.kelvin_springs, *self.kelvin_dashpots)
        if not (self.spring > 0 and self.dashpot > 0 and all(0 < value < np.inf for value in elements)):
            raise InputError(
                "Kelvin chain: a value is not positive; give moduli in Pa and viscosities in Pa s."
            )
        if np.isinf(self.spring) and np.isinf(self.dashpot) and not elements:
            raise InputError("Kelvin chain: it is empty; give a spring, a dashpot or an element.")

    def complex_compliance(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Complex compliance D* = D' - i D'' [1/Pa] at angular frequencies [rad/s].

        D* = 1/E + 1/(i omega eta) + sum of 1/(E_k + i omega eta_k).
        """
        i_omega = 1j * np.asarray(omega, dtype=float)
        elements = np.asarray(self.kelvin_springs) + i_omega[..., None] * np.asarray(self.kelvin_dashpots)
        # An infinite part is an absent one: its compliance is zero.
        return 1.0 / self.spring + 1.0 / self.dashpot / i_omega + (1.0 / elements).sum(axis=-1)

    def complex_modulus(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus E* = 1/D* [Pa] at angular frequencies [rad/s]."""
        return 1.0 / self.complex_compliance(omega)

    def creep_compliance(self, time: ArrayLike) -> NDArray[np.float64]:
        """Strain per unit of constant stress, D(t) [1/Pa], at times after loading [s]."""
        time = np.asarray(time, dtype=float)
        rates = np.divide(self.kelvin_springs, self.kelvin_dashpots)
        # expm1, for 1 - exp cancels where a slow element has barely begun to creep.
        delayed = -np.expm1(-time[..., None] * rates) / np.asarray(self.kelvin_springs)
        return 1.0 / self.spring + time / self.dashpot + delayed.sum(axis=-1)

    def scaled(self, factor: float) -> KelvinChain:
        """The chain with E* times `factor` at every frequency, and the same retardation times."""
        springs = tuple(factor * value for value in self.kelvin_springs)
        dashpots = tuple(factor * value for value in self.kelvin_dashpots)
        return KelvinChain(factor * self.spring, factor * self.dashpot, springs, dashpots)
