"""Faults of one place: of a specimen's channel, of an isotherm, of one specimen's sweep, of a frequency of the machine.

They compete with all other causes, by the same likelihood, and are told with their place and size. The chance of each
is that of all its places together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

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
Factor = Callable[[float, Observations], Complex | complex]
Places = Callable[[Observations], Sequence[Place]]


class PlaceFault(Cause):
    """A fault that is told with its place; what it does is a factor of E*, or a rise of the temperature."""

    told = True

    def __init__(self, name: str, amplitude: Parameter, usual: Expected, at: Places, factor: Factor) -> None:
        self.name, self.parameters, self.expected = name, (amplitude,), usual  # type: ignore[misc]
        self.stage = MATERIAL if amplitude.unit == "K" else CHANNEL  # type: ignore[misc]
        # What an offset of all tests leaves of its own at each isotherm is the machine's.
        self.part_of = PhaseOffset.name if at is isotherms else ""  # type: ignore[misc]
        self._places, self._factor = at, factor

    def places(self, observed: Observations) -> Sequence[Place]:
        """Where it may sit, of several."""
        return self._places(observed)

    def temperature_rise(self, values: Vector, observed: Observations) -> Vector | float:
        """The rise above the stated temperature, where that is what is wrong [K]."""
        return values[0] if self.stage == MATERIAL else 0.0

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """E* times the factor (n,) of the fault; `values` (1,)."""
        return modulus * self._factor(values[0], observed)


def specimens(observed: Observations) -> Sequence[Place]:
    """Each of several, which has gauges of its own."""
    return observed.names if len(observed.names) > 1 else ()


def delayed_specimens(observed: Observations) -> Sequence[Place]:
    """Specimens; at one frequency a delay is an offset."""
    return specimens(observed) if observed.frequencies.size > 1 else ()


def isotherms(observed: Observations) -> Sequence[Place]:
    """Each of several with a few tests."""
    return [float(t) for t in observed.held_isotherms] if observed.isotherms.size > 1 else ()


def sweeps(observed: Observations) -> Sequence[Place]:
    """Each specimen on each isotherm, where both are several."""
    return [Sweep(str(name), float(t)) for name in specimens(observed) for t in isotherms(observed)]  # type: ignore


def ends(observed: Observations) -> Sequence[Place]:
    """The highest and the lowest frequency, where a cycle has few samples, is cut short, or is noted wrongly."""
    every = observed.frequencies
    return [Setting(float(every[-1])), Setting(float(every[0]))] if every.size >= FEWEST else ()


def turned(degrees: float, observed: Observations) -> complex:
    """All phases by one angle."""
    return complex(np.exp(1j * np.radians(degrees)))


def delayed(seconds: float, observed: Observations) -> Complex:
    """Phases in proportion to the frequency."""
    return np.asarray(np.exp(1j * observed.omega * seconds))


def scaled(logarithm: float, observed: Observations) -> complex:
    """|E*| by a gain, a unit or a dimension."""
    return float(np.exp(logarithm))


def unchanged(kelvin: float, observed: Observations) -> complex:
    """What a temperature does is the law's."""
    return 1.0


ANGLE, LEVEL = (
    Parameter("offset", "deg", -30.0, 30.0, 0.5),
    Parameter("logarithm_of_factor", "1", -3.0, 3.0, 0.02),
)
DELAY = Parameter("delay", "s", -2e-2, 2e-2, 1e-4)
WARMER = Parameter(
    "temperature_rise", "K", -25.0, 25.0, 0.3
)  # as far as isotherms whose files were exchanged
OF_ONE_PLACE = (
    PlaceFault("offset of one specimen", ANGLE, Expected(0.1, 1.2), specimens, turned),
    PlaceFault("delay of one specimen", DELAY, Expected(0.03, 2.5e-4), delayed_specimens, delayed),
    PlaceFault("offset of one isotherm", ANGLE, Expected(0.03, 1.2), isotherms, turned),
    # One of a hundred sweeps.
    PlaceFault("temperature of one specimen on one isotherm", WARMER, Expected(0.15, 1.5), sweeps, unchanged),
    PlaceFault("level of one specimen on one isotherm", LEVEL, Expected(0.1, 0.25), sweeps, scaled),
    PlaceFault("offset of one specimen on one isotherm", ANGLE, Expected(0.06, 3.0), sweeps, turned),
    PlaceFault("level at one frequency", LEVEL, Expected(0.05, 0.08), ends, scaled),
    PlaceFault("offset at one frequency", ANGLE, Expected(0.05, 2.5), ends, turned),
)
