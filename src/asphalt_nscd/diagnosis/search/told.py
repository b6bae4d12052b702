"""Faults of one place as `diagnosis.json` holds them: of a specimen's channel, an isotherm, a sweep, a frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes._cause import Setting, Sweep
from asphalt_nscd.diagnosis.causes.one_place import ANGLE, LEVEL
from asphalt_nscd.diagnosis.criteria import NOTICED, TORN
from asphalt_nscd.diagnosis.model import likelihood
from asphalt_nscd.diagnosis.model.fit_beside import State
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.written import interval_95, interval_text


@dataclass(frozen=True)
class Odd:
    """A fault at its place, with the standard error of its size and its probability."""

    candidate: Candidate
    std_error: float
    probability: float = 0.0

    @property
    def kind(self) -> str:
        """Its cause."""
        return self.candidate.cause.name

    @property
    def size(self) -> float:
        """Its size in the unit of its cause."""
        return self.candidate.values[0]

    @property
    def unit(self) -> str:
        """Unit of its size."""
        return self.candidate.cause.parameters[0].unit

    @property
    def largest(self) -> float:
        """Size that is physical, in its unit."""
        return self.candidate.cause.parameters[0].high

    @property
    def specimen(self) -> str | None:
        """Where it is one specimen's."""
        place = self.candidate.place
        return place.specimen if isinstance(place, Sweep) else place if isinstance(place, str) else None

    @property
    def isotherm(self) -> float | None:
        """Where it is one isotherm's [degC]."""
        place = self.candidate.place
        return place.isotherm if isinstance(place, Sweep) else place if isinstance(place, float) else None

    def content(self, widened: float, highest: float) -> dict[str, Any]:
        """Its entry of diagnosis.json, its interval times `widened`, a delay's phase at `highest` [Hz]."""
        low, high = interval_95(self.size, self.std_error, widened)
        how_sure = {"interval_95": [low, high], "probability": self.probability}
        if self.specimen is None:
            side = "above" if self.size > 0.0 else "below"
            sentence = (
                f"At {self.isotherm:g} degC all phases are {interval_text(abs(self.size), 0.5 * (high - low))} deg "
                f"{side} what |E*| and the other temperatures require."
            )
            return {"temperature_C": self.isotherm, "offset_deg": self.size, "sentence": sentence, **how_sure}
        at = {"specimen": self.specimen, "temperature_C": self.isotherm}
        if self.unit == "K":
            return {**at, "kelvin": self.size, **how_sure}
        if self.unit == "s":
            return {**at, "phase_deg": 360.0 * highest * self.size, "delay_s": self.size, **how_sure}
        if self.unit == "deg":
            return {**at, "phase_deg": self.size, **how_sure}
        return {**at, "factor": float(np.exp(self.size))}


@dataclass(frozen=True)
class OneFrequency:
    """What all tests at one frequency [Hz] are off by in ln|E*| and phase [rad], each with standard error."""

    frequency: float
    modulus: tuple[float, float]
    phase: tuple[float, float]

    def rows(self, observed: Observations) -> NDArray[np.bool_]:
        """Tests (n,) at this frequency, of all specimens and temperatures."""
        return np.asarray(observed.frequency == self.frequency)

    def content(self, widened: float) -> dict[str, Any]:
        """The entry `highest_frequency` of `diagnosis.json`; `widened` is the factor on the intervals of all names."""
        return {
            "frequency_Hz": self.frequency,
            # Of a logarithm: 0.29 below is 25 %.
            "modulus_percent": 100.0 * float(np.expm1(self.modulus[0])),
            "modulus_interval_95": [100.0 * float(np.expm1(x)) for x in interval_95(*self.modulus, widened)],
            "phase_deg": float(np.degrees(self.phase[0])),
            "phase_interval_95": [float(np.degrees(end)) for end in interval_95(*self.phase, widened)],
        }


def odd_frequency(estimates: Mapping[tuple, tuple[float, float]], found: list[Odd]) -> OneFrequency | None:
    """The likelier frequency at which something was found, by `estimates` of both parts there."""
    at = [one for one in found if isinstance(one.candidate.place, Setting)]
    if not at:
        return None
    place = max(at, key=lambda one: one.probability).candidate.place
    assert isinstance(place, Setting)
    # What no table could tell from another cause is not sought: nothing is known of it.
    modulus, phase = (
        estimates.get((f"{part} at one frequency", place), (0.0, parameter.high))
        for part, parameter in (("level", LEVEL), ("offset", ANGLE))
    )
    return OneFrequency(place.frequency, modulus, (float(np.radians(phase[0])), float(np.radians(phase[1]))))


def torn_isotherms(state: State) -> list[float]:
    """Isotherms [degC] that follow no one law with the others: their own discrepancy gains too much to be chance."""
    described, whole = state.model.processes.described, state.variances
    misfit = likelihood.estimate(state.model, None, whole).misfit
    torn = []
    for t in state.plain.observed.held_isotherms:
        own = np.array([one.kind == "isotherm" and one.isotherm == t for one in described])
        if not own.any() or np.sqrt(whole[own].max()) < NOTICED:
            continue
        less = likelihood.estimate(state.model.selected(~own), None, whole[~own])
        if less.misfit - misfit > TORN:
            torn.append(float(t))
    return torn
