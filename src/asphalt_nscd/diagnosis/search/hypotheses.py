"""What a table cannot decide: each explanation that it leaves open, with its probability, its law and its causes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.model.fit_beside import State, refit_causes
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.observed.observations import Complex, Vector
from asphalt_nscd.diagnosis.search.ladder import Ladder, Rung

LEAST = 0.03  # probability below which that a cause is absent is left out: none is stated above 0.98


@dataclass(frozen=True)
class Hypothesis:
    """One explanation: its probability, and the law with the causes that go with it, fitted beside the discrepancy."""

    probability: float
    joint: Joint
    fitted: Fitted

    @property
    def causes(self) -> tuple[Candidate, ...]:
        """Those of the rungs, with their values."""
        return tuple(one for one in self.fitted.active if not one.cause.told)

    def effect(self, every: Joint) -> Complex:
        """ln (n,) of what the causes do to E* in each test of `every`."""
        law = self.fitted.law
        return _logarithm(every.apparent(law, self.causes)[0] / every.apparent(law, ())[0])

    def along(self, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """ln E* (n,) of the mix and its derivative (n, p) by the parameters of the free curve."""
        modulus, slope = self.joint.base.modulus(self.fitted.law, omega, temperature)
        return _logarithm(modulus), slope / modulus[:, None]

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Of the parameters (p, p) of the free curve."""
        size = self.fitted.law.size
        return self.fitted.covariance[:size, :size]


def hypotheses(ladder: Ladder, stated: Mapping[tuple, float]) -> list[Hypothesis]:
    """The names as they stand; each undecided one absent, or a rival in its place, the others kept.

    `stated` is the probability of each name, by cause and place. The likeliest first; all add up to one.
    """
    end = ladder.end
    if end is None or not ladder.rungs:
        return [Hypothesis(1.0, ladder.joint, ladder.fitted)]
    found = [(1.0, end), *_others(end, ladder.rungs, stated)]
    whole = sum(odds for odds, _ in found)
    told = [Hypothesis(odds / whole, state.wide, state.fitted) for odds, state in found]
    return sorted(told, key=lambda one: -one.probability)


def _others(end: State, rungs: list[Rung], stated: Mapping[tuple, float]) -> Iterator[tuple[float, State]]:
    """Odds over the names as they stand, and the fit, of each explanation that differs at one name."""
    for rung in rungs:
        key = rung.candidate.key
        named = stated[key]
        # What is stated of a name is less than the model's: so is what is stated of its rivals.
        scale = named / rung.probability
        ways = {rival: share * scale for rival, share in zip(rung.rivals, rung.shares, strict=True)}
        kept = tuple(one for one in end.fitted.active if one.key != key)
        taken = {one.key for one in kept}
        absent = 1.0 - named - sum(ways.values())
        for rival, probability in ways.items():
            if rival.key not in taken:
                yield probability / named, refit_causes(end, (*kept, rival))
        if absent >= LEAST:
            yield absent / named, refit_causes(end, kept)


def _logarithm(modulus: Complex) -> Complex:
    return np.log(np.abs(modulus)) + 1j * np.angle(modulus)
