"""Ranges that no asphalt test leaves, so that a value outside is a slip of unit or sign."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.csvinput import Limits

# A phase may come out a little negative (a delayed channel does that), so its sign is judged over
# the whole table, by `reduction`.
LIMITS = {
    "temperature_C": Limits(
        -80, 120, "give degrees Celsius, or write the unit into the name of the column, as in T (°F) or T (K)"
    ),
    "frequency_Hz": Limits(1e-5, 1000, "give a positive frequency in Hz"),
    "F0_N": Limits(1e-6, 1e5, "give a positive force amplitude in N"),
    "z0_m": Limits(1e-8, 5e-3, "give a positive displacement amplitude in m (63 micrometres are 63e-6)"),
    "psi_deg": Limits(-180, 180, "give the angle by which the force leads, in degrees"),
    "E_MPa": Limits(
        0.1,
        2e5,
        "give |E*| in MPa, greater than zero, or write the unit into the name of the column, as in E (GPa)",
    ),
    "phase_deg": Limits(-90, 90, "give the phase of E* in degrees"),
}

# Norm of E* [MPa] that no mix falls below at 1 Hz, by temperature [degC]: a third or less of that of soft
# and porous ones, and yet above the numbers that stiff ones give in GPa.
_SOFTEST = {-20.0: 1000.0, 0.0: 300.0, 10.0: 120.0, 30.0: 25.0, 50.0: 6.0, 70.0: 2.0, 90.0: 1.0}
_KELVIN_PER_DECADE = 9.0  # of frequency, a usual shift about room temperature


def least_modulus(temperature: ArrayLike, frequency: ArrayLike) -> NDArray[np.float64]:
    """Norm of E* [MPa] below which no asphalt falls, at temperatures [degC] and frequencies [Hz], broadcast."""
    at_one_hertz = np.asarray(temperature) - _KELVIN_PER_DECADE * np.log10(frequency)
    # On the logarithm, for |E*| falls by decades.
    return np.exp(np.interp(at_one_hertz, list(_SOFTEST), np.log(list(_SOFTEST.values()))))
