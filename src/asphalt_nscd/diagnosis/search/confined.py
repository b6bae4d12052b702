"""Faults of one specimen's channel, of one isotherm's, and of one specimen's temperature on one isotherm.

No cause of the catalogue sits there. Each such fault is one direction beside the last fit: an angle or a delay of one
specimen, an angle of one isotherm, kelvins of one specimen's isotherm. It competes with the others and with what the
catalogue has left, beside the discrepancy and what every laboratory adds. What is likelier than not is told; nothing
is taken off the tests.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.criteria import (
    CONFINED,
    DOUBTED,
    LABORATORY,
    MOST_CAUSES,
    NEARLY_SURE,
    NOTICED,
    POSSIBLE,
    TORN,
    Z_95,
)
from asphalt_nscd.diagnosis.model import chance, discrepancy, laboratory, likelihood
from asphalt_nscd.diagnosis.model.fit_beside import State
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted
from asphalt_nscd.diagnosis.model.likelihood import Direction, Estimate, Reduced
from asphalt_nscd.diagnosis.model.probability import log_odds, odds_of, shares
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.search.with_discrepancy import Survey
from asphalt_nscd.diagnosis.written import interval_95, interval_text

OFFSET, DELAY, ISOTHERM, SWEEP = CONFINED  # in the order of criteria
# Discrepancy and laboratory take up a part of each fault, which a linear limit leaves out. Of 12 faults at it in four
# invented tables 6 were told; 4 of the others were told at half as much again, 2 in a table of two specimens were not.
TAKEN_UP = 1.6
_CAUSES = {cause.name: cause for cause in CATALOGUE}
_AS = {OFFSET: "phase_offset", DELAY: "channel_delay", ISOTHERM: "phase_offset", SWEEP: "temperature_bias"}


@dataclass(frozen=True)
class Odd:
    """A fault at its place: kind, of CONFINED; size in its unit, with its standard error and probability."""

    kind: str
    specimen: str | None
    isotherm: float | None
    size: float = 0.0
    std_error: float = np.inf
    probability: float = 0.0

    @property
    def unit(self) -> str:
        """Of its size."""
        return _CAUSES[_AS[self.kind]].parameters[0].unit

    @property
    def largest(self) -> float:
        """Size that is physical, in its unit."""
        return _CAUSES[_AS[self.kind]].parameters[0].high

    def content(self, widened: float, highest: float) -> dict[str, Any]:
        """The fault as diagnosis.json holds it, its interval times `widened`, a delay's phase at `highest` [Hz]."""
        low, high = interval_95(self.size, self.std_error, widened)
        how_sure = {"interval_95": [low, high], "probability": self.probability}
        at = {"temperature_C": self.isotherm}
        if self.kind == SWEEP:
            return {"specimen": self.specimen, **at, "kelvin": self.size, **how_sure}
        if self.kind == OFFSET:
            return {"specimen": self.specimen, **at, "phase_deg": self.size, **how_sure}
        if self.kind == DELAY:
            phase = {"phase_deg": 360.0 * highest * self.size, "delay_s": self.size}
            return {"specimen": self.specimen, **at, **phase, **how_sure}
        side = "above" if self.size > 0.0 else "below"
        sentence = (
            f"At {self.isotherm:g} degC all phases are {interval_text(abs(self.size), 0.5 * (high - low))} deg {side} "
            "what |E*| and the other temperatures require."
        )
        return {**at, "offset_deg": self.size, "sentence": sentence, **how_sure}


@dataclass(frozen=True)
class _Beside:
    """The last fit linearised, and the model reduced to the discrepancy and to what the laboratory adds."""

    linear: Fitted
    model: Reduced

    @cached_property
    def nothing(self) -> Estimate:
        """Without a fault: the likelier of two answers."""
        few = np.where(self.model.processes.usual < 1.0, discrepancy.LEAST, 1.0)
        return _likelier(self.model, None, few)

    def remove_fault(self, direction: NDArray, amplitude: float) -> _Beside:
        """With a fault taken off the tests; direction (2n,) whitened."""
        off = amplitude * direction
        linear = replace(
            self.linear,
            residual=self.linear.residual - off,
            gradient=self.linear.gradient - self.linear.jacobian.T @ off,
        )
        return _Beside(linear, likelihood.reduce(self.model.processes, linear))


def find(state: State, surveyed: Survey) -> tuple[list[Odd], list[float], list[Odd]]:
    """Faults of one place beside the last fit, and isotherms that follow no one law with the others.

    Returns the faults likelier than not, the likeliest first; torn isotherms [degC], once these are taken off; and
    every fault that the table can show, at its detection limit.
    """
    beside, noise = _linear_start(state)
    every, effects = _effects(state)
    places, directions = list(every), noise.whiten(effects)
    whitened = directions
    named = _catalogue_odds(state, surveyed)
    found: list[Odd] = []
    while len(found) < MOST_CAUSES and places:
        judged = list(_judged(beside, places, whitened))
        # Odds of the catalogue are those of the tests as they are, before any fault is off.
        share = shares([*(odds for odds, *_ in judged), *(named if not found else [])])
        if not judged or share[best := int(np.argmax(share[: len(judged)]))] < POSSIBLE:
            break
        _, k, odd, amplitude = judged[best]
        # Of eight above 0.85 in tables of another generator two were false.
        found.append(replace(odd, probability=min(float(share[best]), DOUBTED)))
        beside = beside.remove_fault(whitened[:, k], amplitude)
        del places[k]
        whitened = np.delete(whitened, k, axis=1)
    torn = _torn(beside, state.plain.observed.held_isotherms)
    return found, torn, _limits(beside, every, directions)


def _linear_start(state: State) -> tuple[_Beside, Noise]:
    """Beside what a laboratory adds, in sizes that are estimated anew: a fault would have enlarged them."""
    at = state.fitted
    if state.plain.observed.isotherms.size < 2:
        return _Beside(state.linear, state.model), state.plain.noise
    joint = laboratory.alone(state.plain)
    linear = joint.linearise(at.law, at.scales, at.active)
    return _Beside(linear, likelihood.reduce(laboratory.processes(joint, linear)[0], linear)), joint.noise


def _effects(state: State) -> tuple[list[Odd], NDArray[np.complex128]]:
    """Every fault that the table can show, and what a typical one does to ln E*, (n, k)."""
    observed = state.plain.observed
    places, effects = list[Odd](), list[NDArray[np.complex128]]()

    def add(kind: str, specimen: str | None, isotherm: float | None) -> None:
        rows = np.ones(observed.size, bool)
        if specimen is not None:
            rows &= observed.specimen == observed.names.index(specimen)
        if isotherm is not None:
            rows &= observed.isotherm == isotherm
        # What reaches all tests is a cause of the catalogue.
        if rows.any() and not rows.all():
            places.append(Odd(kind, specimen, isotherm))
            effects.append(along[kind] * rows)

    along = {
        kind: chance.candidate_directions(
            state.plain, state.fitted, [Candidate(_CAUSES[name], None, (0.0,))]
        )[:, 0]
        for kind, name in _AS.items()
    }
    held = [float(t) for t in observed.held_isotherms]
    for name in observed.names:
        add(OFFSET, name, None)
        # At one frequency a delay is an offset.
        if observed.frequencies.size > 1:
            add(DELAY, name, None)
        for t in held if observed.isotherms.size > 1 else ():
            add(SWEEP, name, t)
    # What a common offset leaves of its own at each isotherm is no fault of one of them: NCAT's machine, say.
    for t in held if all(one.cause.name != _AS[ISOTHERM] for one in state.fitted.active) else ():
        add(ISOTHERM, None, t)
    return places, np.column_stack(effects) if effects else np.zeros((observed.size, 0), complex)


def _judged(beside: _Beside, places: list[Odd], whitened: NDArray) -> Iterator[tuple[float, int, Odd, float]]:
    """ln odds, number, fault and amplitude of those that come near."""
    every, nothing = likelihood.directions(beside.model, beside.linear, whitened), beside.nothing
    processes = beside.model.processes
    # what a fault has enlarged: the laboratory's sizes, and the discrepancy of its place
    usual = np.minimum(nothing.variances, processes.usual**2)
    added = np.array([one.kind in LABORATORY for one in processes.described])
    of_one = [one.specimen is not None or one.isotherm is not None for one in processes.described]
    information, score = likelihood.weighed(beside.model, every, np.where(of_one, discrepancy.LEAST, usual))
    near = np.abs(score) > NEARLY_SURE * np.sqrt(np.maximum(np.diag(information), 1e-12))
    for k in np.flatnonzero(near):
        place = places[k]
        same = ((place.specimen, None), (None, place.isotherm))
        own = [
            of and (one.specimen, one.isotherm) in same
            for of, one in zip(of_one, processes.described, strict=True)
        ]
        start = np.where(own, discrepancy.LEAST, np.where(added, usual, nothing.variances))
        one = _likelier(beside.model, every.column(int(k)), start)
        unit = _CAUSES[_AS[place.kind]].parameters[0].typical
        size, error = one.amplitude * unit, one.std_error * unit
        count = sum(other.kind == place.kind for other in places)
        odds = odds_of(CONFINED[place.kind], count, size, error, nothing.misfit - one.misfit)
        yield odds, int(k), replace(place, size=size, std_error=error), one.amplitude


def _limits(beside: _Beside, places: list[Odd], whitened: NDArray) -> list[Odd]:
    """Each fault at its detection limit, where a cause may be so large."""
    if not places:
        return []
    along = likelihood.directions(beside.model, beside.linear, whitened)
    information, _ = likelihood.weighed(beside.model, along, beside.nothing.variances)
    kinds = [place.kind for place in places]
    limits = []
    for place, own in zip(places, np.diag(information), strict=True):
        amplitude, expected = _CAUSES[_AS[place.kind]].parameters[0], CONFINED[place.kind]
        error = amplitude.typical / np.sqrt(max(own, 1e-12))
        # odds without a gain, which half of z squared has to beat
        prior = odds_of(expected, kinds.count(place.kind), NEARLY_SURE * error, error, 0.0)
        size = TAKEN_UP * (max(NEARLY_SURE, np.sqrt(max(-2.0 * prior, 0.0))) + Z_95) * error
        if size <= place.largest:
            limits.append(replace(place, size=size, std_error=error))
    return limits


def _likelier(model: Reduced, cause: Direction | None, start: NDArray) -> Estimate:
    """Of the answers that a start leads to and that the usual sizes do."""
    tried = [likelihood.estimate(model, cause, variances) for variances in (start, None)]
    return min(tried, key=lambda estimate: estimate.misfit)


def _catalogue_odds(state: State, surveyed: Survey) -> list[float]:
    """ln odds of each cause that is not named, at its best place and shape."""
    nothing = likelihood.estimate(state.model, None, state.variances).misfit
    best: dict[tuple, float] = {}
    for candidate, one in zip(surveyed.candidates, surveyed.estimates, strict=True):
        first = candidate.cause.parameters[0]
        size = float(np.clip(one.amplitude * first.typical, first.low, first.high))
        # `shape_cost` would ask for a fit of each shape: here each costs two (Akaike).
        gain = nothing - one.misfit - 2.0 * (len(candidate.values) - 1)
        taken = candidate.replace_values(np.array([size, *candidate.values[1:]]))
        odds = log_odds(taken, state.plain.observed, gain, one.std_error * first.typical)
        best[candidate.key] = max(odds, best.get(candidate.key, -np.inf))
    return list(best.values())


def _torn(beside: _Beside, isotherms: NDArray) -> list[float]:
    """Isotherms [degC] whose own discrepancy gains too much to be chance."""
    described, whole = beside.model.processes.described, beside.nothing
    torn = []
    for t in isotherms:
        own = np.array([one.kind == "isotherm" and one.isotherm == t for one in described])
        if not own.any() or np.sqrt(whole.variances[own].max()) < NOTICED:
            continue
        less = likelihood.estimate(beside.model.only(~own), None, whole.variances[~own])
        if less.misfit - whole.misfit > TORN:
            torn.append(float(t))
    return torn
