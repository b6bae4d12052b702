"""The one search: every cause at every place competes, by one likelihood, beside the discrepancy and the laboratory.

Every cause is tested, sized and limited beside a discrepancy (`discrepancy`) and what a laboratory adds (`laboratory`),
whose sizes are estimated with that cause in the model. What one isotherm, one frequency or one specimen carries alone
is no established cause: each is left out in turn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from asphalt_nscd.diagnosis.causes._cause import CHANNEL, Cause
from asphalt_nscd.diagnosis.criteria import (
    ABSORBED,
    ALPHA_PER_STEP,
    CONFIDENCE,
    FOLLOWED,
    HIDES,
    MOST_CAUSES,
    NEARLY_SURE,
    POSSIBLE,
    SURVIVES,
    TWENTY_TIMES,
    WORTH_SIZING,
)
from asphalt_nscd.diagnosis.model import chance, discrepancy, likelihood
from asphalt_nscd.diagnosis.model.fit_beside import (
    State,
    afresh,
    lean,
    likeliest,
    refit_causes,
    row_processes,
    settle,
    shape_cost,
    smoothed,
    taken_amplitude,
)
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.model.likelihood import Direction, Estimate
from asphalt_nscd.diagnosis.model.probability import log_odds, shares
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import specimen_named

Vector = NDArray[np.float64]
REFITS = 4  # candidates that are refitted at each rung
STARTS = 4  # of a cause with shapes of its own
NEAR = 0.6  # share of what a name needs, above which a candidate is refitted


@dataclass(frozen=True)
class Found:
    """One cause taken: its chance level, states before and after, rivals as good, its probability and theirs."""

    candidate: Candidate
    p_value: float
    before: State
    after: State
    rivals: tuple[Candidate, ...]
    probability: float
    shares: tuple[float, ...] = ()


@dataclass(frozen=True)
class Survey:
    """Every cause that is not in the fit, as if it were the next one: candidates, directions, estimates (k each)."""

    candidates: list[Candidate]
    pointing: Direction
    estimates: list[Estimate]
    one_sided: NDArray[np.bool_]

    def part(self, told: bool) -> Survey:
        """Those that are told with their place, or those that get a rung."""
        kept = [k for k, one in enumerate(self.candidates) if one.cause.told == told]
        return Survey(
            [self.candidates[k] for k in kept],
            self.pointing.column(*kept),
            [self.estimates[k] for k in kept],
            self.one_sided[kept],
        )


def climb(
    state: State, catalogue: Sequence[Cause], draws: int, random: np.random.Generator
) -> tuple[list[Found], State, Survey]:
    """Causes that beat chance and a nameless discrepancy, in the order taken; the last state; all causes estimated."""
    taken: list[Found] = []
    surveyed = survey(state, catalogue)
    # So many causes that get a rung, and so many faults of one place.
    while all(sum(one.candidate.cause.told == told for one in taken) < MOST_CAUSES for told in (True, False)):
        one = _next(state, surveyed, draws, random)
        found = _both_of_the_channel(state, surveyed, draws, random) if one is None else [one]
        if not found:
            break
        taken += found
        # The roughness that a law took on for a cause is given back before the next one is sought.
        state = smoothed(taken[-1].after)
        surveyed = survey(state, catalogue)
    return taken, state, surveyed


def again(
    state: State, kept: Sequence[Found], catalogue: Sequence[Cause]
) -> tuple[list[Found], State, Survey]:
    """The ascent with some causes alone, in their order: what was found, the last state, all causes estimated there."""
    taken: list[Found] = []
    for one in kept:
        candidate = one.after.fitted.active[-1]
        active = (*state.fitted.active, candidate)
        after = settle(state.plain, state.model.processes, state.fitted, active, one.after.variances)
        taken.append(replace(one, before=state, after=after))
        state = smoothed(after)
    return taken, state, survey(state, catalogue)


def survey(state: State, catalogue: Sequence[Cause]) -> Survey:
    """Candidates that the table can show, each estimated beside the discrepancy in this state."""
    candidates, pointing = _pointing(state, catalogue)
    scored = list(_scored(state, pointing))
    promising = set(_promising(state, candidates, pointing))
    estimates = [
        likeliest(state.model, state.variances, pointing.column(k), candidate.place)
        if k in promising
        else scored[k]
        for k, candidate in enumerate(candidates)
    ]
    one_sided = np.array([c.cause.one_sided for c in candidates], bool)
    return Survey(candidates, pointing, estimates, one_sided)


def _scored(state: State, pointing: Direction) -> Iterator[Estimate]:
    """Each candidate beside processes of the sizes that they have without, which no gain is told of."""
    information, score = likelihood.weighed(state.model, pointing, state.variances)
    least = np.maximum(np.diag(information), 1e-12)
    for amplitude, error in zip(score / least, least**-0.5, strict=True):
        yield Estimate(state.variances, np.inf, float(amplitude), float(error))


def _promising(state: State, candidates: Sequence[Candidate], pointing: Direction) -> Iterator[int]:
    """Those worth an estimate: far from none where nothing of one place hides them; of shapes, the best STARTS."""
    found = state.model.processes
    of_one = [one.kind == "all" or (one.specimen or one.isotherm) is not None for one in found.described]
    least = np.where(of_one, discrepancy.LEAST, lean(found, state.variances))
    information, score = likelihood.weighed(state.model, pointing, least)
    z = score / np.sqrt(np.maximum(np.diag(information), 1e-12))
    z = np.where([one.cause.one_sided for one in candidates], z, np.abs(z))
    count: dict[tuple, int] = {}
    for k in np.argsort(-z, kind="stable").tolist():
        key = candidates[k].key
        count[key] = count.get(key, 0) + 1
        far = z[k] > (NEARLY_SURE if candidates[k].cause.told else WORTH_SIZING)
        if far and (count[key] <= STARTS or not candidates[k].shaped):
            yield k


def _next(state: State, surveyed: Survey, draws: int, random: np.random.Generator) -> Found | None:
    candidates, estimates, one_sided = surveyed.candidates, surveyed.estimates, surveyed.one_sided
    if not candidates:
        return None
    # From several starts too: a worse answer for none would pass for a gain of each cause.
    nothing = likeliest(state.model, state.variances)
    z = np.array([estimate.z for estimate in estimates])
    z = np.where(one_sided, np.maximum(z, 0.0), np.abs(z))
    gains = np.array([nothing.misfit - estimate.misfit for estimate in estimates])
    by_chance = largest_by_chance(state, surveyed.part(told=False), draws, random)
    # Places are many, and the chance of a fault is shared by all of its own.
    named = float(np.quantile(by_chance, 1.0 - ALPHA_PER_STEP))
    least = np.where([one.cause.told for one in candidates], NEARLY_SURE, named)
    # A law fitted without the cause has followed it: what comes near is refitted before it is judged.
    large = bool((state.hidden > HIDES**2).any())
    eligible = (z > NEAR * least) & (gains > NEAR * TWENTY_TIMES)
    shortlist: dict[tuple, list[int]] = {}
    for k in np.argsort(-np.where(eligible, gains, -np.inf)):
        key = candidates[k].key
        if eligible[k] and (key in shortlist or len(shortlist) < REFITS):
            shortlist.setdefault(key, []).append(int(k))
    # Of causes that look alike, each is tried in the place of the others, by its best form.
    families = {candidates[group[0]].cause.family for group in shortlist.values()} - {""}
    for k in np.argsort(-gains):
        if candidates[k].cause.family in families:
            shortlist.setdefault(candidates[k].key, [int(k)])
    # A discrepancy sized without an error of all phases may have taken it up whole.
    taken_up = {
        k for k, one in enumerate(candidates) if large and one.cause.stage == CHANNEL and not one.cause.told
    }
    for k in taken_up:
        shortlist.setdefault(candidates[k].key, [k])
    refits = []
    odds: dict[int, float] = {}
    for k in (k for starts in shortlist.values() for k in starts):
        # Of a cause with shapes of its own, a fit that does not stand gives way to one from another start.
        if any(candidates[j].key == candidates[k].key for j in odds):
            continue
        amplitude = estimates[k].amplitude * candidates[k].typical[0]
        first = candidates[k].cause.parameters[0]
        values = np.array([np.clip(amplitude, first.low, first.high), *candidates[k].values[1:]])
        active = (*state.fitted.active, candidates[k].replace_values(values))
        after = settle(state.plain, state.model.processes, state.fitted, active, estimates[k].variances)
        if k in taken_up:
            after = min(after, afresh(state, active), key=lambda one: one.misfit)
        if not candidates[k].shaped:
            # A law that had followed the cause needs no such roughness beside it.
            after = min(after, smoothed(after), key=lambda one: one.misfit)
        taken = after.fitted.active[-1]
        gain = state.misfit - after.misfit - shape_cost(after.fitted, taken, state.plain.observed)
        if gain > TWENTY_TIMES:
            own = taken_amplitude(after, taken)
            # The law refitted with a cause leaves it more than the law that had followed it.
            z[k] = max(z[k], abs(own.z))
            if not stands(state, after, taken, own):
                continue
            odds[k] = log_odds(taken, state.plain.observed, gain, own.std_error * float(taken.typical[0]))
            refits.append((gain, k, after))
    if all(z[k] <= least[k] for _, k, _ in refits):
        return None
    sure = {candidates[k].cause.family for _, k, _ in refits if z[k] > least[k]} - {""}
    refits = [one for one in refits if z[one[1]] > least[one[1]] or candidates[one[1]].cause.family in sure]
    most = max(gain for gain, _, _ in refits)
    as_good = [refit for refit in refits if most - refit[0] < TWENTY_TIMES]
    # Equals in gain are told apart by what is usual of them, and not by a trifle; one at its bound comes last.
    gain, k, after = max(as_good, key=lambda refit: (not refit[2].fitted.active[-1].pinned, odds[refit[1]]))
    rivals = {j: other.fitted.active[-1] for _, j, other in as_good if j != k}
    share = dict(zip(odds, shares(list(odds.values())).tolist(), strict=True))
    # A name and what fits as well are told together: they share their probability.
    if sum(share[j] for _, j, _ in as_good) < POSSIBLE:
        return None
    # Of what its family let in, the gain decided: a discrepancy sized without it hides its score.
    score = float(z[k]) if z[k] > least[k] else max(float(z[k]), float(np.sqrt(gain)))
    p_value = chance.tail(by_chance, score)
    taken, theirs = after.fitted.active[-1], tuple(share[j] for j in rivals)
    return Found(taken, p_value, state, after, tuple(rivals.values()), share[k], theirs)


def _both_of_the_channel(
    state: State, surveyed: Survey, draws: int, random: np.random.Generator
) -> list[Found]:
    """An offset and a delay of all tests, where a discrepancy takes up both and leaves neither alone a gain."""
    pair = [c for c in surveyed.candidates if c.cause.stage == CHANNEL and c.place is None]
    if len(pair) != 2 or not (state.hidden > HIDES**2).any():
        return []
    both = smoothed(afresh(state, (*state.fitted.active, *pair)))
    taken = both.fitted.active[-2:]
    own = [taken_amplitude(both, one) for one in taken]
    errors = [one.std_error * float(candidate.typical[0]) for one, candidate in zip(own, taken, strict=True)]
    gain, observed = state.misfit - both.misfit, state.plain.observed
    odds = log_odds(taken[0], observed, gain, errors[0]) + log_odds(taken[1], observed, 0.0, errors[1])
    by_chance = largest_by_chance(state, surveyed, draws, random)
    least = max(CONFIDENCE, float(np.quantile(by_chance, 1.0 - ALPHA_PER_STEP)))
    share = float(expit(odds))
    if gain < 2.0 * TWENTY_TIMES or share < POSSIBLE or min(abs(one.z) for one in own) < least:
        return []
    first = settle(both.plain, both.model.processes, both.fitted, both.fitted.active[:-1], both.variances)
    p_values = [chance.tail(by_chance, abs(one.z)) for one in own]
    return [
        Found(taken[0], p_values[0], state, first, (), share),
        Found(taken[1], p_values[1], first, both, (), share),
    ]


def stands(before: State, state: State, taken: Candidate, own: Estimate) -> bool:
    """Whether a cause competes for the place of the next name: what does not takes no probability from one that does.

    Its size is not zero. One with shapes of its own follows almost any structure: it must be carried by the whole
    table, and its shapes must not be at the edge of what they may be.
    """
    if not taken.shaped:
        return bool(abs(own.z) >= CONFIDENCE)
    return not (taken.pinned or hangs_on(state, taken, before))


def _pointing(state: State, catalogue: Sequence[Cause]) -> tuple[list[Candidate], Direction]:
    """Candidates that are not taken yet and that the table can show, with their directions."""
    taken = {candidate.key for candidate in state.fitted.active}
    every = chance.catalogue_candidates(state.plain.observed, catalogue)
    candidates = [c for c in every if c.key not in taken and (c.cause.part_of, None) not in taken]
    if not candidates:
        return [], Direction(np.zeros((state.model.along.size, 0)), np.zeros((0, 0)), np.zeros(0))
    d = state.plain.noise.whiten(chance.candidate_directions(state.plain, state.fitted, candidates))
    pointing = likelihood.directions(state.model, state.linear, d)
    # A law that was fitted without a spring has followed it and leaves little of its direction: a fit with the spring
    # decides. It may follow all of most others, as a shift may of an error of temperature.
    fitted = [isinstance(c.place, str) or c.cause.followed for c in candidates]
    least = np.where(fitted, FOLLOWED, ABSORBED)
    left, size = np.diag(pointing.own), (d**2).sum(axis=0)
    seen = np.flatnonzero(left > least * np.maximum(size, 1e-300))
    return [candidates[k] for k in seen], pointing.column(*seen.tolist())


def largest_by_chance(state: State, surveyed: Survey, draws: int, random: np.random.Generator) -> Vector:
    """The largest score of a survey in each of `draws` tables without a cause (draws,)."""
    correlation, _ = likelihood.correlation(state.model, surveyed.pointing, state.variances)
    return chance.largest_by_chance(correlation, surveyed.one_sided, state.plain.noise.freedom, draws, random)


def hangs_on(state: State, candidate: Candidate, before: State | None = None) -> list[str]:
    """What must not be left out for a cause to be seen: isotherms, frequencies, specimens; best none.

    A cause with shapes of its own is judged by what it gains over a fit without it: its shapes make its size uncertain
    long before they make it doubtful that there is one. `before` is that fit, made here if not given.
    """
    observed = state.plain.observed
    sign, carried = np.sign(candidate.values[0]), []
    if candidate.shaped and before is None:
        before = refit_causes(state, tuple(one for one in state.fitted.active if one.key != candidate.key))
    # Akaike's price of a free parameter, for each shape.
    freedom = 2.0 * (len(candidate.values) - 1)
    for name, label, words in _parts(observed):
        for value in np.unique(label):
            rows = np.flatnonzero(label != value)
            rest = observed.subset(rows)
            if not candidate.cause.rows(rest, candidate.place).any() or not _enough(rest, name):
                continue
            if before is not None and candidate.shaped:
                lost = _misfit_of(before, rows) - _misfit_of(state, rows) - freedom < SURVIVES**2
            else:
                lost = sign * taken_amplitude(state, candidate, rows).z < SURVIVES
            if lost:
                carried.append(words(value))
    return carried


def _misfit_of(state: State, rows: NDArray) -> float:
    """-2 ln of the likelihood of some rows, as `State.misfit`: one step of law and causes, the sizes estimated anew."""
    plain = Joint(state.plain.observed.subset(rows), state.plain.base, state.plain.noise.subset(rows))
    linear = plain.linearise(state.fitted.law, state.fitted.scales, state.fitted.active)
    found, start = row_processes(state.model.processes, plain, rows, state.variances)
    law = linear.law.size + linear.scales.size
    return (
        linear.objective
        - float(linear.gradient @ np.linalg.solve(linear.precision, linear.gradient))
        + float(np.linalg.slogdet(linear.precision[:law, :law])[1])
        + likelihood.estimate(likelihood.reduce(found, linear), start=start).misfit
    )


def _parts(observed: Observations) -> Iterator[tuple[str, NDArray, Callable[[Any], str]]]:
    yield "isotherm", observed.isotherm, lambda t: f"{t:g} degC"
    yield "frequency", observed.frequency, lambda f: f"{f:g} Hz"
    yield "specimen", observed.specimen, lambda s: specimen_named(observed.names[s])


def _enough(rest: Observations, name: str) -> bool:
    """Whether what is left still is a table that can show a cause."""
    left = {"isotherm": rest.isotherms.size, "frequency": rest.frequencies.size}
    left["specimen"] = np.unique(rest.specimen).size
    # One specimen is a table still; one isotherm has no shift, one frequency no slope.
    return left[name] > (0 if name == "specimen" else 1)
