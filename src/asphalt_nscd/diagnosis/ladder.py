"""The ladder: at each rung the cause that gains most when fitted jointly with the law, if it beats chance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from asphalt_nscd.diagnosis import chance, hidden_bias, limits, with_discrepancy
from asphalt_nscd.diagnosis.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.causes._cause import Cause
from asphalt_nscd.diagnosis.chance import ALPHA_PER_STEP, DELTA_DEVIANCE, Scores
from asphalt_nscd.diagnosis.discrepancy import Process
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.start import fit_spectrum, marginal_likelihood
from asphalt_nscd.diagnosis.written import CONFIDENCE, widening

RUNGS = 4
SHORTLIST = 0.4  # candidates whose score gain is above this share of the best are refitted
MOST_REFITS = 8
MOST_PLACES = 20  # isotherms of a cause that are refitted beside them
USUAL = 7.0  # typical amplitudes, standard deviation of errors in laboratories: 2 K, say
AS_MUCH = 0.97  # of the gain of the best nameless pattern, which may be the cause's own
EXCESS = 4.0  # standard deviations of the misfit above which it is structure
NEEDED = 12.0  # of the objective, that a cause gains beside the others named
MOSTLY = 0.75  # share of the structure that named causes must explain, else no name is given
NOTICED = 0.1  # size of a process over the scatter of one test, below which it is none


@dataclass(frozen=True)
class Rung:
    """One step: the cause taken, its chance level, the fits before and after, and who did as well."""

    candidate: Candidate
    p_value: float
    before: Fitted
    after: Fitted
    rivals: tuple[Candidate, ...]


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

    Where structure was left, it was climbed anew beside a discrepancy: discrepancy holds the size of each of
    its processes in units of the scatter, hangs_on what must not be left out for a cause to be seen, estimates
    the amplitude and standard error of every cause. withdrawn: causes that the first ascent named and the
    second did not.
    """

    joint: Joint
    start: Fitted
    rungs: list[Rung] = field(default_factory=list)
    withdrawn: list[Rung] = field(default_factory=list)
    remaining: Remaining | None = None
    limits: dict[tuple, float] = field(default_factory=dict)
    unseen: list[Candidate] = field(default_factory=list)
    alike: list[tuple[Candidate, Candidate]] = field(default_factory=list)
    discrepancy: dict[Process, float] = field(default_factory=dict)
    hangs_on: dict[tuple, list[str]] = field(default_factory=dict)
    estimates: dict[tuple, tuple[float, float]] = field(default_factory=dict)

    @property
    def fitted(self) -> Fitted:
        """The fit with all causes named."""
        return self.rungs[-1].after if self.rungs else self.start

    def std_errors(self, candidate: Candidate) -> NDArray[np.float64]:
        """Of each parameter of a named cause in the last fit, that of the amplitude with the discrepancy's sizes."""
        fitted = self.fitted
        first = fitted.jacobian.shape[1] - sum(len(one.values) for one in fitted.active)
        for active in fitted.active:
            if active.key == candidate.key:
                break
            first += len(active.values)
        at = slice(first, first + len(candidate.values))
        errors = np.sqrt(np.diag(fitted.covariance))[at] * candidate.typical
        errors[0] = max(errors[0], self.estimates.get(candidate.key, (0.0, 0.0))[1])
        return errors

    @property
    def unsure(self) -> Candidate | None:
        """The named cause whose 95 % interval, as it is told, holds zero by most; None where none does."""
        wide = widening(self.estimates_spread) * CONFIDENCE
        reach = [
            (abs(one.values[0]) / max(wide * float(self.std_errors(one)[0]), 1e-300), one)
            for one in self.fitted.active
        ]
        least, one = min(reach, key=lambda pair: pair[0], default=(np.inf, None))
        return one if least <= 1.0 else None

    @property
    def estimates_spread(self) -> float:
        """Root mean square of the estimates of causes without a name, in their standard errors; 1 at least.

        What a table holds and no process of its discrepancy describes spreads them all (genomic control of Devlin and
        Roeder 1999). An effect of a limit times this spread was named in 55 of 61 cases, one of the limit in 41 of 62.
        """
        named = {rung.candidate.cause.name for rung in self.rungs}
        squares: dict[str, list[float]] = {}
        for (name, _), (value, error) in self.estimates.items():
            if name not in named and 0.0 < error < np.inf:
                squares.setdefault(name, []).append((value / error) ** 2)
        each = [float(np.mean(one)) for one in squares.values()]
        return max(1.0, float(np.sqrt(np.mean(each)))) if each else 1.0

    @property
    def noticed(self) -> dict[Process, float]:
        """The discrepancy without processes of no size."""
        return {process: size for process, size in self.discrepancy.items() if size > NOTICED}


def climb(joint: Joint, start: Fitted, catalogue: Sequence[Cause], draws: int, seed: int) -> Ladder:
    """Take causes until none beats chance, then judge what remains."""
    random = np.random.default_rng(seed)
    ladder = Ladder(joint, start)
    fitted = start
    for _ in range(RUNGS + 1):
        taken = {candidate.key for candidate in fitted.active}
        candidates = [c for c in chance.catalogue_candidates(joint.observed, catalogue) if c.key not in taken]
        found, one_sided, gains = _scores(joint, fitted, candidates)
        by_chance = chance.largest_by_chance(found, one_sided, joint.noise.freedom, draws, random)
        ladder.remaining = _remaining(joint, fitted, draws, random)
        if not ladder.rungs:
            threshold = float(np.quantile(by_chance, 1.0 - ALPHA_PER_STEP)) + chance.Z_95
            first = joint, fitted, candidates, found, threshold
        if not gains.size or len(ladder.rungs) == RUNGS:
            break
        begun = None if ladder.rungs else _begun_with(joint, fitted, candidates, gains.max())
        p_value = chance.tail(by_chance, float(np.sqrt(begun[0] if begun else gains.max())))
        if p_value > ALPHA_PER_STEP:
            break
        if begun:
            joint, rung = begun[1], replace(begun[2], p_value=p_value)
            ladder.joint, ladder.start = joint, rung.before
        else:
            rung = _best(
                joint, fitted, candidates, gains, p_value, np.quantile(by_chance, 1.0 - ALPHA_PER_STEP) ** 2
            )
        if not _stands_out(rung, ladder.remaining):
            break
        ladder.rungs.append(rung)
        fitted = rung.after
    _drop_needless(ladder, draws, random)
    left = _structure_left(ladder)
    # One isotherm does not tell what is its own from what is common to all.
    if left and isinstance(joint.base, FlexibleSpectrum) and joint.observed.isotherms.size > 1:
        _climb_beside(ladder, joint, start, catalogue, draws, random)
        return ladder
    ladder.limits, ladder.unseen = limits.detection_limits(*first)
    ladder.alike = limits.alike(first[2], first[3], DELTA_DEVIANCE)
    if left:
        _withdraw(ladder, draws, random)
    return ladder


def _structure_left(ladder: Ladder) -> bool:
    """Whether more stays than scatter."""
    if ladder.remaining is None:
        return False
    return ladder.remaining.p_value <= ALPHA_PER_STEP or _excess(ladder) >= EXCESS * np.sqrt(
        2.0 * ladder.fitted.residual.size
    )


def _excess(ladder: Ladder) -> float:
    """Squares of the residuals beyond what scatter leaves."""
    fitted = ladder.fitted
    used = np.trace(np.linalg.solve(fitted.precision, fitted.jacobian.T @ fitted.jacobian))
    return float(fitted.residual @ fitted.residual) - (fitted.residual.size - used)


def _climb_beside(
    ladder: Ladder,
    joint: Joint,
    start: Fitted,
    catalogue: Sequence[Cause],
    draws: int,
    random: np.random.Generator,
) -> None:
    """The ladder again, beside a discrepancy; every cause with what it hangs on."""
    begun = with_discrepancy.begin(joint, start)
    found, end, survey = with_discrepancy.climb(begun, catalogue, draws, random)
    ladder.withdrawn = list(ladder.rungs)
    _take(ladder, begun, found, end)
    ladder.estimates = with_discrepancy.estimates(end, survey)
    while (one := ladder.unsure) is not None:
        found = [other for other in found if other.candidate.key != one.key]
        found, end, survey = with_discrepancy.again(begun, found, catalogue)
        _take(ladder, begun, found, end)
        ladder.estimates = with_discrepancy.estimates(end, survey)
    named = {one.candidate.key for one in found}
    ladder.withdrawn = [rung for rung in ladder.withdrawn if rung.candidate.key not in named]
    ladder.hangs_on = {c.key: with_discrepancy.hangs_on(end, c) for c in end.fitted.active}
    ladder.limits, ladder.unseen, ladder.alike = with_discrepancy.detection_limits(end, survey, draws, random)
    sizes = np.sqrt(end.variances)
    ladder.discrepancy = dict(zip(end.model.processes.described, sizes.tolist(), strict=True))
    ladder.remaining = _remaining(end.plain, end.linear, draws, random)


def _take(
    ladder: Ladder,
    begun: with_discrepancy.State,
    found: Sequence[with_discrepancy.Found],
    end: with_discrepancy.State,
) -> None:
    """Rungs and fits of an ascent beside a discrepancy."""
    ladder.joint, ladder.start = end.wide, begun.fitted
    ladder.rungs = [
        Rung(one.candidate, one.p_value, one.before.fitted, one.after.fitted, one.rivals) for one in found
    ]
    # A rung ends where the next begins, with the roughness of the law chosen anew.
    ends = [*(rung.before for rung in ladder.rungs[1:]), end.fitted]
    ladder.rungs = [replace(rung, after=after) for rung, after in zip(ladder.rungs, ends, strict=False)]


def _stands_out(rung: Rung, remaining: Remaining) -> bool:
    """Whether the cause does no worse than the best nameless pattern; else its name would be forced."""
    more = len(rung.candidate.values) - 1
    gain = rung.before.objective - rung.after.objective
    return gain - more * DELTA_DEVIANCE >= AS_MUCH * remaining.simple


def _scores(
    joint: Joint, fitted: Fitted, candidates: list[Candidate]
) -> tuple[Scores, NDArray[np.bool_], NDArray[np.float64]]:
    directions = chance.candidate_directions(joint, fitted, candidates)
    confined = np.array([isinstance(c.place, str) for c in candidates], bool)
    one_sided = np.array([c.cause.parameters[0].low >= 0.0 for c in candidates], bool)
    found = chance.scores(joint, fitted, directions, confined)
    gains = chance.effective(found, one_sided) ** 2
    return found, one_sided, np.maximum(gains, hidden_bias.gains(joint, fitted, candidates, found.seen))


def _best(
    joint: Joint,
    fitted: Fitted,
    candidates: list[Candidate],
    gains: NDArray[np.float64],
    p_value: float,
    least: float,
) -> Rung:
    """The candidate of largest gain when refitted jointly, among those that come near it by their score.

    With them the other isotherms of such a cause: a shift bent towards the one that is off hides it. Of those
    as good the one of fewest parameters: a loss bump far above the band is a delay with three more. Of one cause at
    several places the likeliest by its size too: one isotherm off by 3 K rather than the next by 8 K.
    """
    order = np.argsort(-gains)
    least = min(least, gains.max())  # few draws know the tail better than its quantile
    shortlist: dict[tuple, Candidate] = {}
    for k in order:
        if gains[k] >= max(SHORTLIST * gains.max(), least) and len(shortlist) < MOST_REFITS:
            shortlist.setdefault(candidates[k].key, candidates[k])
    bent = {name for name, place in shortlist if isinstance(place, float)}
    others = [candidates[k] for k in order if candidates[k].cause.name in bent]
    for candidate in others[:MOST_PLACES]:
        shortlist.setdefault(candidate.key, candidate)
    refits = [joint.fit(fitted.law, fitted.scales, (*fitted.active, c)) for c in shortlist.values()]
    gained = np.array([fitted.objective - refit.objective for refit in refits])
    gained -= [2.0 * (len(c.values) - 1) for c in shortlist.values()]
    as_good = np.flatnonzero(gained.max() - gained < DELTA_DEVIANCE)
    best = min(as_good, key=lambda k: (len(refits[k].active[-1].values), -gained[k]))
    cause = refits[best].active[-1].cause
    same = [k for k in as_good if refits[k].active[-1].cause is cause]
    best = max(same, key=lambda k: gained[k] - _by_size(refits[k].active[-1]))
    rivals = tuple(refits[k].active[-1] for k in as_good if k != best)
    return Rung(refits[best].active[-1], p_value, fitted, refits[best], rivals)


def _by_size(candidate: Candidate) -> float:
    """What the objective takes for the size of an error, as large as errors usually are."""
    return float((candidate.values[0] / (USUAL * candidate.typical[0])) ** 2)


def _begun_with(
    joint: Joint, fitted: Fitted, candidates: list[Candidate], least: float
) -> tuple[float, Joint, Rung] | None:
    """The best of the causes that a law follows far, fitted from the start, if it gains more than `least`."""
    best = None
    for candidate in candidates:
        if candidate.cause.like_a_law and isinstance(joint.base, FlexibleSpectrum):
            present = candidate.with_values(np.array([candidate.typical[0], *candidate.values[1:]]))
            smooth, after = fit_spectrum(joint.observed, joint.noise, (present,))
            gain = 2.0 * (marginal_likelihood(smooth, after) - marginal_likelihood(joint, fitted))
            if gain > least:
                least = gain
                best = (
                    gain,
                    smooth,
                    Rung(after.active[0], 1.0, smooth.fit(after.law, after.scales), after, ()),
                )
    return best


def _remaining(joint: Joint, fitted: Fitted, draws: int, random: np.random.Generator) -> Remaining:
    """The largest nameless pattern, and whether specimens depend on the frequency each in its own way."""
    patterns = chance.structures(joint.observed)
    directions = np.column_stack([pattern.direction for pattern in patterns])
    anywhere = np.zeros(len(patterns), bool)
    found = chance.scores(joint, fitted, directions, anywhere)
    by_chance = chance.largest_by_chance(found, anywhere, joint.noise.freedom, draws, random)
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
        kept = value > 1e-3
        square = float((((vector.T @ found.z)[kept]) ** 2 / value[kept]).sum())
        rank = int(kept.sum())
        if rank == 0:
            continue  # each specimen has frequencies of its own: the law takes all of it
        p_value = 2.0 * float(fdtrc(rank, joint.noise.freedom, square / rank))
        out.append(
            Remaining(min(p_value, 1.0), f"each specimen at each frequency, {name}", max(square - rank, 0.0))
        )
    return out


def _drop_needless(ladder: Ladder, draws: int, random: np.random.Generator) -> None:
    """Take back a cause that those taken after it made superfluous, or whose size may be zero."""
    while ladder.rungs:
        fitted, joint = ladder.fitted, ladder.joint
        losses = {}
        for rung in ladder.rungs:
            rest = tuple(c for c in fitted.active if c.key != rung.candidate.key)
            losses[rung.candidate.key] = (
                joint.fit(fitted.law, fitted.scales, rest).objective - fitted.objective
            )
        needless = [key for key in losses if len(losses) > 1 and losses[key] <= NEEDED]
        unsure = [] if ladder.unsure is None else [ladder.unsure.key]
        if not needless + unsure:
            return
        least = min(needless + unsure, key=lambda key: losses[key])
        kept = [rung.candidate.key for rung in ladder.rungs if rung.candidate.key != least]
        p_values = {rung.candidate.key: rung.p_value for rung in ladder.rungs}
        rivals = {rung.candidate.key: rung.rivals for rung in ladder.rungs}
        ladder.rungs.clear()
        before = ladder.start
        for key in kept:
            candidate = next(c for c in fitted.active if c.key == key)
            after = joint.fit(before.law, before.scales, (*before.active, candidate))
            ladder.rungs.append(Rung(after.active[-1], p_values[key], before, after, rivals[key]))
            before = after
        ladder.remaining = _remaining(joint, before, draws, random)


def _withdraw(ladder: Ladder, draws: int, random: np.random.Generator) -> None:
    """No name where more structure stays than the named causes should leave."""
    assert ladder.remaining is not None
    left = max(_excess(ladder), ladder.remaining.gain)
    while ladder.rungs:
        rung = ladder.rungs[-1]
        gain = rung.before.objective - rung.after.objective
        if gain > MOSTLY / (1.0 - MOSTLY) * left:
            return
        ladder.withdrawn.insert(0, ladder.rungs.pop())
        ladder.remaining = _remaining(ladder.joint, ladder.fitted, draws, random)
