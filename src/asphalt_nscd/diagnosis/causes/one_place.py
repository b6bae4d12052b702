"""Faults of one place: of a specimen's channel, of an isotherm, of one specimen's sweep, of a frequency of the machine.

They compete with all other causes, by the same likelihood, and are told with their place and size. The chance of each
is that of all its places together.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from asphalt_nscd.diagnosis.causes._cause import (
    CHANNEL,
    MATERIAL,
    Cause,
    Complex,
    Expected,
    Parameter,
    Place,
    Setting,
    Sweep,
    Vector,
)
from asphalt_nscd.diagnosis.causes.phase_offset import PhaseOffset
from asphalt_nscd.diagnosis.observed.observations import Observations

FEWEST = 3  # frequencies: of two neither is the wrong one


class OfOnePlace(Cause):
    """A fault that is told with its place; what it does is a factor of E*."""

    stage = CHANNEL
    told = True

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """E* times the factor (n,) of the fault; `values` (1,)."""
        return modulus * self.factor(values[0], observed)

    def factor(self, size: float, observed: Observations) -> Complex | complex:
        """What E* is multiplied by, (n,) or one for all; an angle unless a fault says more."""
        return np.exp(1j * np.radians(size))


def sweeps(observed: Observations) -> Sequence[Place]:
    """Each specimen on each isotherm with a few tests, where both are several."""
    if observed.isotherms.size < 2 or len(observed.names) < 2:
        return ()
    return [Sweep(name, float(t)) for name in observed.names for t in observed.held_isotherms]


def ends(observed: Observations) -> Sequence[Place]:
    """The highest and the lowest frequency, where a cycle has few samples, or is cut short."""
    every = observed.frequencies
    return [Setting(float(every[-1])), Setting(float(every[0]))] if every.size >= FEWEST else ()


class OffsetOfSpecimen(OfOnePlace):
    """Each specimen has gauges of its own."""

    name = "offset of one specimen"
    parameters = (Parameter("offset", "deg", -30.0, 30.0, 0.5),)
    expected = Expected(0.1, 1.2)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each specimen of several."""
        return observed.names if len(observed.names) > 1 else ()


class DelayOfSpecimen(OfOnePlace):
    """The displacement of one specimen is recorded later than the force."""

    name = "delay of one specimen"
    parameters = (Parameter("delay", "s", -2e-2, 2e-2, 1e-4),)
    expected = Expected(0.03, 2.5e-4)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each specimen of several; at one frequency a delay is an offset."""
        return observed.names if len(observed.names) > 1 and observed.frequencies.size > 1 else ()

    def factor(self, size: float, observed: Observations) -> Complex:
        """An angle in proportion to the frequency."""
        return np.asarray(np.exp(1j * observed.omega * size))


class OffsetOfIsotherm(OfOnePlace):
    """All phases of one isotherm are off."""

    name = "offset of one isotherm"
    part_of = PhaseOffset.name  # what is left of one without a single size is the machine's
    parameters = (Parameter("offset", "deg", -30.0, 30.0, 0.5),)
    expected = Expected(0.03, 1.2)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each isotherm of several."""
        return [float(t) for t in observed.held_isotherms] if observed.isotherms.size > 1 else ()


class TemperatureOfSweep(OfOnePlace):
    """A specimen was not at the temperature of its isotherm: one of a hundred sweeps."""

    name = "temperature of one specimen on one isotherm"
    stage = MATERIAL
    # As far as two isotherms whose files were exchanged.
    parameters = (Parameter("temperature_rise", "K", -25.0, 25.0, 0.3),)
    expected = Expected(0.15, 1.5)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each sweep."""
        return sweeps(observed)

    def temperature_rise(self, values: Vector, observed: Observations) -> Vector | float:
        """The rise of the specimen above the stated temperature [K]."""
        return values[0]

    def factor(self, size: float, observed: Observations) -> complex:
        """What the temperature does to the modulus is the law's."""
        return 1.0


class LevelOfSweep(OfOnePlace):
    """A gain, a unit or a dimension is wrong in one sweep."""

    name = "level of one specimen on one isotherm"
    parameters = (Parameter("logarithm_of_factor", "1", -3.0, 3.0, 0.02),)
    expected = Expected(0.1, 0.25)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each sweep."""
        return sweeps(observed)

    def factor(self, size: float, observed: Observations) -> complex:
        """The factor of its logarithm."""
        return float(np.exp(size))


class PhaseOfSweep(OfOnePlace):
    """The phases of one sweep are off by an angle."""

    name = "offset of one specimen on one isotherm"
    parameters = (Parameter("offset", "deg", -30.0, 30.0, 0.5),)
    expected = Expected(0.06, 3.0)

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each sweep."""
        return sweeps(observed)


class LevelOfFrequency(OfOnePlace):
    """|E*| is off at the highest or lowest frequency: too few samples in a cycle, or a frequency noted wrongly."""

    name = "level at one frequency"
    parameters = (Parameter("logarithm_of_factor", "1", -3.0, 3.0, 0.02),)
    expected = Expected(0.05, 0.08)

    def places(self, observed: Observations) -> Sequence[Place]:
        """The highest and the lowest."""
        return ends(observed)

    def factor(self, size: float, observed: Observations) -> complex:
        """The factor of its logarithm."""
        return float(np.exp(size))


class PhaseOfFrequency(OfOnePlace):
    """The phases at the highest or lowest frequency are off by an angle."""

    name = "offset at one frequency"
    parameters = (Parameter("offset", "deg", -30.0, 30.0, 0.5),)
    expected = Expected(0.05, 2.5)

    def places(self, observed: Observations) -> Sequence[Place]:
        """The highest and the lowest."""
        return ends(observed)
