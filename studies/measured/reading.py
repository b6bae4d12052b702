"""What a machine reads of a linear mix: each test a haversine from rest, fitted without a term for the drift.

Ten cycles, of which the last five are read, as usual machines do. Exact for the law: a Kelvin chain follows it from a
thousandth of the lowest frequency on, and the chain is solved in closed form (`rheology/as_run.py`).
"""

from collections.abc import Callable

import numpy as np

from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.spectrum import Spectrum

Modulus = Callable[[np.ndarray, np.ndarray], np.ndarray]  # E* [Pa] at omega [rad/s] and temperature [degC]
PROGRAMME = Programme(cycles=10, read=5)
BELOW, ABOVE = 1e-3, 3.0  # of the lowest and highest frequency: more moves a phase by less than 0.03 degrees


def chain_at(modulus: Modulus, omega: np.ndarray, temperature: float) -> KelvinChain:
    """The chain that follows E* [Pa] of all omega and temperatures around these omega [rad/s], at one [degC]."""

    def at(w: np.ndarray) -> np.ndarray:
        return np.asarray(modulus(w, np.full_like(w, temperature)))

    return kelvin_chain(at, BELOW * omega.min(), ABOVE * omega.max())[0]


def log_reading(law: Spectrum, omega: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    """ln of what is read over E* (n,) at omega [rad/s] and temperature [degC]; its imaginary part is phase [rad]."""
    found = np.empty(omega.size, complex)
    for value in np.unique(temperature):
        at = temperature == value
        chain = chain_at(law.complex_modulus, omega[at], value)
        read = [modulus_as_read(chain, [w / (2.0 * np.pi)], PROGRAMME)[0] for w in omega[at]]
        found[at] = np.log(np.array(read) / law.complex_modulus(omega[at], temperature[at]))
    return found
