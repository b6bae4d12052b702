from collections.abc import Sequence
from itertools import product

import numpy as np

from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Complex, Expected, Parameter, Vector
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
    expected = Expected(0.02, 2e9)  # Pa
    plain = ("a second peak of the loss modulus", "(secondary process) of {}")
    sentence = "a second relaxation process, with a shift of its own, adds a loss bump"
    confirmed_by = "tests at more frequencies, or the loss peak of the binder"
    shows_in = "tests that a law fits; in these, what the law misses would pass for a second loss peak"

    def shows(self, observed: Observations) -> bool:
        """Whether there are three isotherms and three frequencies or more."""
        return observed.isotherms.size > 2 and observed.frequencies.size > 2

    def shapes(self, observed: Observations) -> Sequence[tuple[float, ...]]:
        """Starts of the search: a peak anywhere in the tested band, which shifts less than the mix.

        45 triples of log10 of the time [s], activation energy [kJ/mol] and exponent [-]; the times cover the band at
        the middle temperature.
        """
        # Its peak anywhere in the tested band at the middle temperature, shifting less than the mix.
        slow, fast = -np.log10(observed.omega.min()) + 0.5, -np.log10(observed.omega.max()) - 0.5
        times, energies, exponents = np.linspace(fast, slow, 5), (30.0, 60.0, 90.0), (0.5, 0.65, 0.8)
        return tuple(product(times.tolist(), energies, exponents))

    def largest(self, observed: Observations) -> float:
        """A share of the stiffest test [Pa]: a bump above it is the main process, and a law follows it."""
        return SECONDARY * float(np.abs(observed.modulus).max())

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Add a Cole-Cole process to E*: E* + strength (i omega tau)^a / (1 + (i omega tau)^a) (n,) [Pa].

        `values` (4,): strength [Pa], log10 of the time tau [s] at the middle isotherm of the whole table, activation
        energy [kJ/mol], exponent a [-].
        """
        strength, log_time, energy, exponent = values
        # Of the whole table, so that its time means the same where isotherms are left out.
        middle = float(np.median(observed.table.isotherms)) + ZERO_CELSIUS
        kelvin = observed.temperature + ZERO_CELSIUS
        log_shift = energy * 1e3 / GAS_CONSTANT * (1.0 / kelvin - 1.0 / middle)
        power = (1j * observed.omega * 10.0**log_time * np.exp(log_shift)) ** exponent
        return modulus + strength * power / (1.0 + power)
