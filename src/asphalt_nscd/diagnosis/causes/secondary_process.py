from collections.abc import Sequence
from itertools import product

import numpy as np

from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Complex, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.rheology.shift import GAS_CONSTANT, ZERO_CELSIUS

SECONDARY = 0.2  # of the stiffest |E*|


class SecondaryProcess(Cause):
    """A second loss bump (Cole-Cole) with an Arrhenius shift of its own."""

    name = "secondary_process"
    stage = MATERIAL
    parameters = (
        Parameter("strength", "Pa", 0.0, 2e10, 2e8),
        Parameter("log10_time", "log10(s)", -9.0, 4.0, 1.0),
        Parameter("activation_energy", "kJ/mol", 10.0, 120.0, 30.0),
        Parameter("exponent", "-", 0.3, 1.0, 0.2),
    )
    sentence = "a second relaxation process, with a shift of its own, adds a loss bump"
    confirmed_by = "tests at more frequencies, or the loss peak of the binder"
    shows_in = "tests that a law fits; in these, what the law misses would pass for a second loss peak"

    def shows(self, observed: Observations) -> bool:
        """All tests, where there are three isotherms and three frequencies or more.

        Parameters
        ----------
        observed : Observations
            Measured tests.

        Returns
        -------
        bool
            True if so.
        """
        return observed.isotherms.size > 2 and observed.frequencies.size > 2

    def shapes(self, observed: Observations) -> Sequence[tuple[float, ...]]:
        """Starts of its search: a peak anywhere in the tested band, which shifts less than the mix.

        Parameters
        ----------
        observed : Observations
            Measured tests, whose band the times cover at the middle temperature.

        Returns
        -------
        sequence of tuple of float
            45 of log10 of the time [s], activation energy [kJ/mol] and exponent [-].
        """
        # Its peak anywhere in the tested band at the middle temperature, shifting less than the mix.
        slow, fast = -np.log10(observed.omega.min()) + 0.5, -np.log10(observed.omega.max()) - 0.5
        times, energies, exponents = np.linspace(fast, slow, 5), (30.0, 60.0, 90.0), (0.5, 0.65, 0.8)
        return tuple(product(times.tolist(), energies, exponents))

    def largest(self, observed: Observations) -> float:
        """A share of the stiffest test: a bump above it is the main process, and a law follows it.

        Parameters
        ----------
        observed : Observations
            Measured tests.

        Returns
        -------
        float
            Strength [Pa].
        """
        return SECONDARY * float(np.abs(observed.modulus).max())

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """A Cole-Cole process added to E*; its time is that at the middle isotherm of the whole table.

        Parameters
        ----------
        modulus : ndarray of complex (n,)
            E* before [Pa].
        values : ndarray (4,)
            Strength [Pa], log10 of the time [s], activation energy [kJ/mol], exponent a [-].
        observed : Observations
            Measured tests.

        Returns
        -------
        ndarray of complex (n,)
            E* + strength (i omega tau)^a / (1 + (i omega tau)^a) [Pa].
        """
        strength, log_time, energy, exponent = values
        # Of the whole table, so that its time means the same where isotherms are left out.
        middle = float(np.median(observed.table.isotherms)) + ZERO_CELSIUS
        kelvin = observed.temperature + ZERO_CELSIUS
        log_shift = energy * 1e3 / GAS_CONSTANT * (1.0 / kelvin - 1.0 / middle)
        power = (1j * observed.omega * 10.0**log_time * np.exp(log_shift)) ** exponent
        return modulus + strength * power / (1.0 + power)
