"""The ladder: at each rung the cause that gains most when fitted jointly with the law, if it beats chance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import Cause, Setting
from asphalt_nscd.diagnosis.criteria import CONFIDENCE, DOUBTED, NOTICED, USUAL_THRESHOLD
from asphalt_nscd.diagnosis.model import chance, fit_beside
from asphalt_nscd.diagnosis.model.discrepancy import Process
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.search import limits, one_search
from asphalt_nscd.diagnosis.search.doubts import Key, find_doubts
from asphalt_nscd.diagnosis.search.told import Odd, OneFrequency, odd_frequency, torn_isotherms
from asphalt_nscd.diagnosis.written import widening

NAMES = frozenset(cause.name for cause in CATALOGUE)
ONE_SIGN = frozenset(cause.name for cause in CATALOGUE if cause.one_sided)


@dataclass(frozen=True)
class Rung:
    """One step of the ladder: a cause, its chance level, the fits, rivals as good, its probability and theirs."""

    candidate: Candidate
    p_value: float
    before: Fitted
    after: Fitted
    rivals: tuple[Candidate, ...]
    probability: float
    shares: tuple[float, ...] = ()


@dataclass(frozen=True)
class Remaining:
    """Structure that no cause explains: the least p-value, of which pattern, and what it would gain.

    simple: gain of the best pattern of one amplitude, which a cause has to equal to be named.
    """

    p_value: float
    pattern: str
    gain: float
    simple: float = 0.0


@dataclass
class Ladder:
    """What was climbed.

    `withdrawn`: interval holds zero. `estimates` (with standard error) by cause and place. `discrepancy`: sizes in
    units of the scatter. `odd`: faults of one place, which have no rung. `end` and `survey`: the last state, and what
    causes would be in it; `threshold`: score that chance alone seldom passes there.
    """

    joint: Joint
    start: Fitted
    rungs: list[Rung] = field(default_factory=list)
    withdrawn: list[Rung] = field(default_factory=list)
    remaining: Remaining | None = None
    discrepancy: dict[Process, float] = field(default_factory=dict)
    estimates: dict[tuple, tuple[float, float]] = field(default_factory=dict)
    odd: list[Odd] = field(default_factory=list)
    doubts: dict[Key, list[str]] = field(default_factory=dict)
    at_highest: OneFrequency | None = None
    end: fit_beside.State | None = None
    survey: one_search.Survey | None = None
    threshold: float = USUAL_THRESHOLD

    @cached_property
    def fitted(self) -> Fitted:
        """The last fit as it is without faults of one place, which are told and stay in the tests."""
        if self.end is None:
            return self.rungs[-1].after if self.rungs else self.start
        at = self.end.fitted
        named = tuple(one for one in at.active if not one.cause.told)
        return at if named == at.active else self.end.wide.linearise(at.law, at.scales, named)

    # What follows costs as much as the search: a second opinion, which asks for names alone, goes without.
    @cached_property
    def limits(self) -> dict[tuple, float]:
        """Amplitude that would show, by cause and place."""
        return self._detection_limits[0]

    @property
    def unseen(self) -> list[Candidate]:
        """Causes that these tests show at no size."""
        return self._detection_limits[1]

    @property
    def alike(self) -> list[tuple[Candidate, Candidate]]:
        """Causes that these tests do not tell apart."""
        return self._detection_limits[2]

    @cached_property
    def _detection_limits(
        self,
    ) -> tuple[dict[tuple, float], list[Candidate], list[tuple[Candidate, Candidate]]]:
        if self.end is None or self.survey is None:
            return {}, [], []
        return limits.detection_limits(self.end, self.survey.part(told=False), self.threshold)

    @cached_property
    def smallest(self) -> list[Odd]:
        """Faults of one specimen or isotherm at their detection limits."""
        if self.end is None or self.survey is None:
            return []
        found = [Odd(*one) for one in limits.place_limits(self.end, self.survey.part(told=True))]
        return [one for one in found if not isinstance(one.candidate.place, Setting)]

    @cached_property
    def torn(self) -> list[float]:
        """Isotherms [degC] that follow no one law with the others."""
        return [] if self.end is None else torn_isotherms(self.end)

    @cached_property
    def hangs_on(self) -> dict[tuple, list[str]]:
        """What must not be left out for a name to be found, by cause and place."""
        end = self.end
        return {} if end is None else {one.key: one_search.hangs_on(end, one) for one in self.named}

    @property
    def named(self) -> list[Candidate]:
        """Causes, in the order taken."""
        return [rung.candidate for rung in self.rungs]

    @property
    def confined_faults(self) -> list[dict[str, Any]]:
        """Faults of one place as `diagnosis.json` holds them."""
        highest = float(self.joint.observed.frequencies[-1])
        widened = widening(self.estimates_spread)
        return [
            one.content(widened, highest) for one in self.odd if not isinstance(one.candidate.place, Setting)
        ]

    def std_errors(self, candidate: Candidate) -> NDArray[np.float64]:
        """Standard errors (p,) of a named cause in its units; that of the amplitude with the discrepancy's sizes."""
        fitted = self.fitted
        first = fitted.place_of(candidate.key)
        at = slice(first, first + len(candidate.values))
        errors = np.sqrt(np.diag(fitted.covariance))[at] * candidate.typical
        # The larger of both: the fit takes the sizes of the discrepancy for known, the estimate does not.
        errors[0] = max(errors[0], self.estimates.get(candidate.key, (0.0, 0.0))[1])
        return errors

    @property
    def unsure(self) -> Candidate | None:
        """The named cause whose 95 % interval, as it is told, holds zero by most; None where none does.

        That of a cause with shapes of its own holds no zero: whether there is one is judged by what it gains.
        """
        wide = widening(self.estimates_spread) * CONFIDENCE
        reach = [
            (abs(one.values[0]) / max(wide * float(self.std_errors(one)[0]), 1e-300), one)
            for one in self.fitted.active
            if not one.shaped
        ]
        least, one = min(reach, key=lambda pair: pair[0], default=(np.inf, None))
        return one if least <= 1.0 else None

    @property
    def estimates_spread(self) -> float:
        """Root mean square of the estimates of causes without a name, in their standard errors; 1 at least.

        What a table holds and no process of its discrepancy describes spreads them all (genomic control of Devlin and
        Roeder 1999). An effect of a limit times this spread was named in 55 of 61 cases, one of the limit in 41 of 62.
        """
        return spread_of(self.estimates, frozenset(rung.candidate.cause.name for rung in self.rungs))

    @property
    def noticed(self) -> dict[Process, float]:
        """The discrepancy without processes of no size."""
        return {process: size for process, size in self.discrepancy.items() if size > NOTICED}


def lawless(joint: Joint, fitted: Fitted, draws: int, seed: int) -> Ladder:
    """Nothing is climbed where no law is common to all temperatures, against which a cause could be held."""
    return Ladder(joint, fitted, remaining=_remaining(joint, fitted, draws, np.random.default_rng(seed)))


def climb(begun: fit_beside.State, catalogue: Sequence[Cause], draws: int, seed: int) -> Ladder:
    """Take causes until none beats chance and a discrepancy without a name, then judge what remains."""
    random = np.random.default_rng(seed)
    ladder = Ladder(begun.wide, begun.fitted)
    found, end, survey = one_search.climb(begun, catalogue, draws, random)
    _take(ladder, begun, found, end, survey)
    # The weakest goes first and alone: without it the others may hold.
    while (one := ladder.unsure) is not None:
        ladder.withdrawn += [rung for rung in ladder.rungs if rung.candidate.key == one.key]
        found = [other for other in found if other.candidate.key != one.key]
        found, end, survey = one_search.again(begun, found, catalogue)
        _take(ladder, begun, found, end, survey)
    ladder.doubts = find_doubts(end, ladder.named) | ladder.doubts
    ladder.survey = survey
    ladder.threshold = limits.chance_threshold(end, survey.part(told=False), draws, random)
    sizes = np.sqrt(end.hidden).tolist()
    ladder.discrepancy = {
        one: size for one, size in zip(end.model.processes.described, sizes, strict=True) if size > 0.0
    }
    everyday = end.everyday
    at = everyday.linearise(end.fitted.law, end.fitted.scales, end.fitted.active)
    ladder.remaining = _remaining(everyday, at, draws, random)
    return ladder


def _take(
    ladder: Ladder,
    begun: fit_beside.State,
    found: Sequence[one_search.Found],
    end: fit_beside.State,
    survey: one_search.Survey,
) -> None:
    """Rungs, faults of one place and fits of an ascent."""
    ladder.joint, ladder.start, ladder.end = end.wide, begun.fitted, end
    ladder.__dict__.pop("fitted", None)
    # A rung ends where the next begins, with the roughness of the law chosen anew.
    ends = [*(one.before.fitted for one in found[1:]), end.fitted]
    estimates = limits.estimates(end, survey)
    ladder.estimates = {key: size for key, size in estimates.items() if key[0] in NAMES}
    active = {candidate.key: candidate for candidate in end.fitted.active}
    ladder.rungs, ladder.odd, ladder.doubts = [], [], {}
    for one, after in zip(found, ends, strict=False):
        key = one.candidate.key
        if one.candidate.cause.told:
            # Of eight above 0.85 in tables of another generator two were false.
            ladder.odd.append(Odd(active[key], estimates[key][1], min(one.probability, DOUBTED)))
            continue
        rivals = [pair for pair in zip(one.rivals, one.shares, strict=True) if not pair[0].cause.told]
        as_good, their = tuple(other for other, _ in rivals), tuple(share for _, share in rivals)
        rung = Rung(one.candidate, one.p_value, one.before.fitted, after, as_good, one.probability, their)
        ladder.rungs.append(rung)
        if len(rivals) < len(one.rivals):
            ladder.doubts[key] = ["A fault of one specimen, isotherm or frequency fits as well"]
    ladder.at_highest = odd_frequency(estimates, ladder.odd)


def _remaining(joint: Joint, fitted: Fitted, draws: int, random: np.random.Generator) -> Remaining:
    """The largest nameless pattern, and whether specimens depend on the frequency each in its own way."""
    patterns = chance.structures(joint.observed)
    directions = np.column_stack([pattern.direction for pattern in patterns])
    anywhere = np.zeros(len(patterns), bool)
    found = chance.scores(joint, fitted, directions, anywhere)
    by_chance = chance.largest_by_chance(found.correlation, anywhere, joint.noise.freedom, draws, random)
    k = int(np.argmax(np.abs(found.z)))
    largest = float(abs(found.z[k]))
    alone = Remaining(chance.tail(by_chance, largest), patterns[k].name, largest**2)
    least = min([alone, *_interactions(joint, fitted)], key=lambda remaining: remaining.p_value)
    return replace(least, simple=largest**2)


def _interactions(joint: Joint, fitted: Fitted) -> list[Remaining]:
    """F tests of a residual that each specimen has at each frequency, in modulus and in phase."""
    observed = joint.observed
    pairs = np.column_stack([observed.specimen, observed.frequency])
    members = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
    if len(observed.names) < 2 or observed.size < 2 * (members.max() + 1):
        return []
    out = []
    for name, unit in (("modulus", 1.0 + 0j), ("phase", 1j)):
        found = chance.scores(
            joint,
            fitted,
            np.asarray(unit * np.eye(members.max() + 1)[members], complex),
            np.ones(members.max() + 1, bool),
        )
        value, vector = np.linalg.eigh(found.correlation)
        # What the law takes up leaves eigenvalues of rounding, of which a quotient says nothing.
        kept = value > 1e-3
        square = float((((vector.T @ found.z)[kept]) ** 2 / value[kept]).sum())
        rank = int(kept.sum())
        if rank == 0:
            continue  # each specimen has frequencies of its own: the law takes all of it
        # Twice, for modulus and phase are both tried.
        p_value = 2.0 * float(fdtrc(rank, joint.noise.freedom, square / rank))
        out.append(
            Remaining(min(p_value, 1.0), f"each specimen at each frequency, {name}", max(square - rank, 0.0))
        )
    return out


def spread_of(estimates: Mapping[tuple, tuple[float, float]], left_out: Set[str]) -> float:
    """Root mean square of estimates in their standard errors, 1 at least; those of an impossible sign do not count."""
    squares: dict[str, list[float]] = {}
    for (name, _), (value, error) in estimates.items():
        if name not in left_out and 0.0 < error < np.inf and not (value < 0.0 and name in ONE_SIGN):
            squares.setdefault(name, []).append((value / error) ** 2)
    # A cause that may sit at many places counts once, as any other.
    each = [float(np.mean(one)) for one in squares.values()]
    return max(1.0, float(np.sqrt(np.mean(each)))) if each else 1.0
