"""Shift of frequency with temperature, for thermo-rheologically simple mixes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.errors import InputError

GAS_CONSTANT = 8.314462618  # J/(mol K)
ZERO_CELSIUS = 273.15  # K


@dataclass(frozen=True)
class WLF:
    """Shift of Williams, Landel & Ferry (1955), log10 a_T = -c1 (T - T_ref) / (c2 + T - T_ref).

    `c1` in decades, `c2` in K, `reference_temperature` T_ref in degC.

    >>> WLF(c1=24.0, c2=160.0, reference_temperature=15.0).factor([5, 15, 25]).round(3).tolist()
    [39.811, 1.0, 0.039]
    """

    c1: float
    c2: float
    reference_temperature: float

    def factor(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """Shift factor a_T, reduced frequency over frequency, at temperatures [degC]; 1 at the reference.

        A temperature where c2 + T - T_ref is not positive is refused, because the shift is not defined there.
        """
        above = np.asarray(temperature, dtype=float) - self.reference_temperature
        # Beyond its singularity the formula turns its sign: a colder mix would be softer.
        if np.any(self.c2 + above <= 0.0):
            raise InputError(
                f"WLF shift: it is not defined {np.min(self.c2):g} K below {self.reference_temperature:g} "
                "degC or colder; take a higher temperature or an Arrhenius shift."
            )
        return 10.0 ** (-self.c1 * above / (self.c2 + above))

    def log_slopes(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """Derivatives (n, 2) of ln a_T by ln c1 and ln c2, at temperatures (n,) [degC]."""
        above = np.asarray(temperature, dtype=float) - self.reference_temperature
        log_factor = -np.log(10.0) * self.c1 * above / (self.c2 + above)
        return np.column_stack([log_factor, -log_factor * self.c2 / (self.c2 + above)])


@dataclass(frozen=True)
class Arrhenius:
    """Shift by one activation energy Q, ln a_T = Q/R (1/T - 1/T_ref), temperatures in K.

    `activation_energy` Q in J/mol, `reference_temperature` T_ref in degC.

    >>> Arrhenius(activation_energy=200e3, reference_temperature=15.0).factor([5, 15, 25]).round(3).tolist()
    [20.11, 1.0, 0.061]
    """

    activation_energy: float
    reference_temperature: float

    def factor(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """Shift factor a_T, reduced frequency over frequency, at temperatures [degC]; 1 at the reference."""
        kelvin = np.asarray(temperature, dtype=float) + ZERO_CELSIUS
        inverse = 1.0 / kelvin - 1.0 / (self.reference_temperature + ZERO_CELSIUS)
        return np.exp(self.activation_energy / GAS_CONSTANT * inverse)

    def log_slopes(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """Derivative (n, 1) of ln a_T by ln(activation_energy), at temperatures (n,) [degC]."""
        # ln a_T is proportional to the energy, and so is its own slope by ln Q.
        return np.log(self.factor(temperature))[:, None]


SHIFTS = {"wlf": WLF, "arrhenius": Arrhenius}
