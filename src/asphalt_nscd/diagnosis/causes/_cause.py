"""What a cause is: a forward model on the apparent modulus, and how the simulation takes it up."""

from __future__ import annotations

from abc import ABC
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.files.words import three_digits
from asphalt_nscd.measurements.kinds import TEST_TYPES


class Sweep(NamedTuple):
    """Tests of one specimen on one isotherm [degC]."""

    specimen: str
    isotherm: float


class Setting(NamedTuple):
    """All tests at one frequency [Hz]."""

    frequency: float


Place = str | float | Sweep | Setting | None
"""The specimen (name), isotherm [degC], sweep or frequency a cause is confined to; None for the whole table."""

# In the order in which a signal passes them. One of CHANNEL has one parameter and no place: it is fitted before the
# errors of the laboratory are sized (`model.laboratory`), and beside every large discrepancy
# (`search.one_search`). What sits at HEAD with one parameter and no place, and each of CHANNEL, is pooled over
# a machine's campaigns too (`machine.pooled`).
MATERIAL, SPECIMEN, HEAD, CHANNEL = range(4)
EXCESS = (
    "phases above what |E*| requires"  # of an offset, of a mix that is not linear, of a drift read as phase
)


@dataclass(frozen=True)
class Parameter:
    """One parameter of a cause, with its bounds and the `typical` size at which its effect is about a per cent."""

    name: str
    unit: str
    low: float
    high: float
    typical: float


@dataclass(frozen=True)
class Expected:
    """Prior: the `chance` that a campaign has a cause at all, and its usual `size` in the unit of its amplitude.

    Both are judgements, to a factor of two or so, of what happens on such benches; no survey of laboratories is at
    hand. A factor of two in a chance moves the size that is named by some 5 %.
    """

    chance: float
    size: float


def less(value: float, unit: str) -> str:
    """What takes a value off, in words: "subtract 1.2 deg from"."""
    way = ("subtract", "from") if value > 0.0 else ("add", "to")
    return f"{way[0]} {three_digits(abs(value))} {unit} {way[1]}"


class Cause(ABC):
    """One physical cause. The first parameter is its amplitude: at zero the cause is absent.

    signs: what an amplitude above and one below zero mean; none where only one sign can be.
    confirmed_by: the measurement that would confirm it. needs: what the table must have for it to show.
    shows_in: a design in which it shows, where one that could have shown it does not.
    confined_to: what it sits at, one "specimen" or one isotherm ("temperature_C"); empty where it reaches all tests.
    benches: test types (`Observations.test_type`) whose apparatus can have it.
    unseen: what it is called where its detection limit is told to everybody, as of the commonest faults.
    plain: what it is, and the rest of it with its size, where the size alone says little.
    alike: what never tells it from another explanation, as two names; empty where these tests may.
    followed: whether a law fitted without it follows it, so that only a fit with it decides.
    alters_tests: whether what it does is taken off the tests once it is established; what a mix does itself is not.
    family: what causes have in common that these tests may not tell apart: each is tried in the place of the others.
    told: whether it is told with its place and size, and gets no rung: what nobody mends in the tests afterwards.
    part_of: the cause of all tests that leaves it no place once it is in the fit.
    """

    name: ClassVar[str]
    stage: ClassVar[int]
    parameters: ClassVar[tuple[Parameter, ...]]
    sentence: ClassVar[str]  # what is wrong, for a reader of the report
    signs: ClassVar[tuple[str, str] | None] = None
    confirmed_by: ClassVar[str]
    needs: ClassVar[str] = ""
    shows_in: ClassVar[str] = "other tests: in these, the master curve can bend to hide it"
    confined_to: ClassVar[str] = ""
    benches: ClassVar[tuple[str, ...]] = tuple(TEST_TYPES)
    expected: ClassVar[Expected]
    unseen: ClassVar[str] = ""
    plain: ClassVar[tuple[str, str] | None] = None
    alike: ClassVar[tuple[str, str] | None] = None
    followed: ClassVar[bool] = False
    alters_tests: ClassVar[bool] = True
    family: ClassVar[str] = ""
    told: ClassVar[bool] = False
    part_of: ClassVar[str] = ""

    @property
    def one_sided(self) -> bool:
        """Whether its amplitude cannot be below zero."""
        return self.parameters[0].low >= 0.0

    def places(self, observed: Observations) -> Sequence[Place]:
        """Specimens, isotherms [degC] or None (all tests) where it may sit; empty if the table or the bench cannot."""
        return (None,) if self.possible_on_bench(observed) and self.shows(observed) else ()

    def shows(self, observed: Observations) -> bool:
        """Whether the table can show the cause at all: yes, unless a cause says what it takes."""
        return True

    def possible_on_bench(self, observed: Observations) -> bool:
        """Whether the apparatus can have the cause; True too if no cause is of this bench and every bench can."""
        if observed.test_type not in TEST_TYPES:  # only what every test can have
            return set(TEST_TYPES) <= set(self.benches)
        return observed.test_type in self.benches

    def shapes(self, observed: Observations) -> Sequence[tuple[float, ...]]:
        """Values of the parameters after the first at which the search starts, at least one set of them."""
        return ((),)

    def variants(self) -> Sequence[Cause]:
        """The cause in each form that it may have; one form, unless a cause says more."""
        return (self,)

    def rows(self, observed: Observations, place: Place) -> NDArray[np.bool_]:
        """Rows (n,) of the table that the cause reaches from its place."""
        if place is None:
            return np.ones(observed.size, bool)
        if isinstance(place, str):
            return observed.specimen == observed.names.index(place)
        if isinstance(place, Sweep):
            of_specimen = observed.specimen == observed.names.index(place.specimen)
            return of_specimen & (observed.isotherm == place.isotherm)
        if isinstance(place, Setting):
            return observed.frequency == place.frequency
        # Exactly: places are isotherms of the same table.
        return observed.isotherm == place

    def largest(self, observed: Observations) -> float:
        """Amplitude above which no detection limit is stated [unit of the first parameter]; no such cause is larger."""
        return self.parameters[0].high

    def impossible(self, values: Vector, observed: Observations) -> str:
        """Say why these tests cannot have a cause of this size; empty where they can."""
        return ""

    def correction(self, value: float, place: Place) -> str:
        """What to do to the tests to be rid of it, where one number does; empty elsewhere. `value` of its amplitude."""
        return ""

    def temperature_rise(self, values: Vector, observed: Observations) -> Vector | float:
        """Temperature of the mix above the one stated [K], (n,) or one for all; `values` (p,) in their units."""
        return 0.0

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Modulus E* (n,) after this cause, of the one before it [Pa]; analytic in the modulus; `values` (p,)."""
        return modulus

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """What it changes in the simulation (keys of `rig.read_rig`); `form_factor` in 1/m, `amplitude` in m.

        Empty where it varies with temperature or frequency, for a sample has one rig; and where it is of the mix or the
        specimen: `simulation.extension` puts those into the law of the bonds.
        """
        return {}
