"""A continuous spectrum: the 2S2P1D law (Olard & Di Benedetto 2003) with a WLF shift.

Two parabolic creep elements and a dashpot give one smooth law for all frequencies; the shift of
Williams, Landel & Ferry (1955) carries it to all temperatures (a thermo-rheologically simple mix).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class TwoS2P1D:
    """2S2P1D law of one mix.

    static_modulus, glassy_modulus: limits of E* at zero and infinite frequency [Pa]; k < h: exponents
    of the parabolic elements; delta: weight of the k element; tau: characteristic time [s] at
    reference_temperature [degC]; beta: dashpot, viscosity = (glassy - static) beta tau;
    wlf_c1 (decades), wlf_c2 [K].
    """

    static_modulus: float
    glassy_modulus: float
    k: float
    h: float
    delta: float
    tau: float
    beta: float
    wlf_c1: float
    wlf_c2: float
    reference_temperature: float

    def shift_factor(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """a_T: reduced frequency over frequency at temperature [degC]; 1 at the reference."""
        above = np.asarray(temperature, dtype=float) - self.reference_temperature
        return 10.0 ** (-self.wlf_c1 * above / (self.wlf_c2 + above))

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """E* [Pa] at angular frequencies omega [rad/s] and temperatures [degC], broadcast together."""
        reduced = 1j * np.asarray(omega, dtype=float) * self.tau * self.shift_factor(temperature)
        retarded = 1.0 + self.delta * reduced**-self.k + reduced**-self.h + 1.0 / (reduced * self.beta)
        return self.static_modulus + (self.glassy_modulus - self.static_modulus) / retarded
