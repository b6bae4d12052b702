"""The ladder of a table that holds more than its law, its causes and its scatter.

Every cause is tested, sized and limited beside a discrepancy (`discrepancy`), whose size is estimated with
that cause in the model. What one isotherm, one frequency or one specimen carries alone is no established
cause: each is left out in turn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logit

from asphalt_nscd.diagnosis import chance, discrepancy, likelihood, limits
from asphalt_nscd.diagnosis.causes._cause import CHANNEL, Cause
from asphalt_nscd.diagnosis.chance import Scores
from asphalt_nscd.diagnosis.criteria import (
    ABSORBED,
    ALPHA_PER_STEP,
    CONFIDENCE,
    FOLLOWED,
    HIDES,
    MOST_CAUSES,
    POSSIBLE,
    SURVIVES,
    TWENTY_TIMES,
    USUAL_THRESHOLD,
    Z_95,
)
from asphalt_nscd.diagnosis.discrepancy import Processes
from asphalt_nscd.diagnosis.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.likelihood import Direction, Estimate, Reduced
from asphalt_nscd.diagnosis.observations import Observations
from asphalt_nscd.diagnosis.probability import log_odds, shares
from asphalt_nscd.diagnosis.start import first_laws, of_likeliest_roughness
from asphalt_nscd.files.words import specimen_named

Vector = NDArray[np.float64]
SEVERAL_STARTS = 300  # tests up to which the sizes of the discrepancy are sought from several starts
REFITS = 4  # candidates that are refitted at each rung
STARTS = 4  # of a cause with shapes of its own
NEAR = 0.6  # share of what a name needs, above which a candidate is refitted
SETTLED = 2  # rounds of fitting law and discrepancy in turn
LARGER = 6  # times that a limit is raised by a quarter where a discrepancy would take the effect up
CONVERGED = 0.01  # change of the objective at which a fit beside a discrepancy ends


@dataclass(frozen=True)
class State:
    """A fit of law and causes beside the discrepancy, and the model linearised there.

    Parameters
    ----------
    plain : Joint
        The joint model whose noise is the scatter alone.
    wide : Joint
        With the discrepancy.
    fitted : Fitted
        Under wide.
    linear : Fitted
        Under plain, at the same parameters.
    model : Reduced
        Reduced to the processes.
    variances : ndarray (m,)
        Of the processes.
    """

    plain: Joint
    wide: Joint
    fitted: Fitted
    linear: Fitted
    model: Reduced
    variances: Vector

    @property
    def misfit(self) -> float:
        """-2 ln of the likelihood with the law integrated out (Laplace), the causes at their best."""
        law = self.fitted.law.size + self.fitted.scales.size
        return (
            self.fitted.objective
            + float(np.linalg.slogdet(self.fitted.precision[:law, :law])[1])
            + self.wide.noise.log_determinant
            + self.model.processes.prior(self.variances)[0]
        )


@dataclass(frozen=True)
class Found:
    """One cause taken.

    Parameters
    ----------
    candidate : Candidate
        The cause.
    p_value : float
        How likely by chance.
    before, after : State
        The states.
    rivals : tuple of Candidate
        Who did as well.
    probability : float
        As of `ladder.Rung`.
    """

    candidate: Candidate
    p_value: float
    before: State
    after: State
    rivals: tuple[Candidate, ...]
    probability: float


@dataclass(frozen=True)
class Survey:
    """Every cause that is not in the fit, as if it were the next one: candidates, directions, estimates (k each)."""

    candidates: list[Candidate]
    pointing: Direction
    estimates: list[Estimate]
    one_sided: NDArray[np.bool_]


def begin(plain: Joint, fitted: Fitted) -> State:
    """Law and discrepancy with the causes of the fit, mostly none.

    Parameters
    ----------
    plain : Joint
        The joint model whose noise is the scatter alone.
    fitted : Fitted
        Where it stands.

    Returns
    -------
    State
        The first state.
    """
    found = discrepancy.processes(plain, fitted)
    start = likelihood.estimate(likelihood.reduce(found, fitted)).variances
    return _smoothed(_settle(plain, found, fitted, fitted.active, start))


def with_causes(state: State, active: tuple[Candidate, ...]) -> State:
    """Fitted anew with other causes.

    Parameters
    ----------
    state : State
        To start from.
    active : tuple of Candidate
        The causes.

    Returns
    -------
    State
        With them.
    """
    return _settle(state.plain, state.model.processes, state.fitted, active, state.variances)


def climb(
    state: State, catalogue: Sequence[Cause], draws: int, random: np.random.Generator
) -> tuple[list[Found], State, Survey]:
    """Causes that beat both chance and a discrepancy without a name, one after the other.

    Parameters
    ----------
    state : State
        To start from.
    catalogue : sequence of Cause
        Causes.
    draws : int
        Of the chance level.
    random : Generator
        Whence.

    Returns
    -------
    list of Found
        In the order taken.
    State
        The last one.
    Survey
        All causes, estimated there.
    """
    taken: list[Found] = []
    surveyed = survey(state, catalogue)
    while len(taken) < MOST_CAUSES:
        found = _next(state, surveyed, draws, random)
        if found is None:
            break
        taken.append(found)
        state = _smoothed(found.after)
        surveyed = survey(state, catalogue)
    return taken, state, surveyed


def again(
    state: State, kept: Sequence[Found], catalogue: Sequence[Cause]
) -> tuple[list[Found], State, Survey]:
    """The ascent with some causes alone, in their order.

    Parameters
    ----------
    state : State
        Without any cause.
    kept : sequence of Found
        The causes.
    catalogue : sequence of Cause
        All causes.

    Returns
    -------
    list of Found
        In the order taken.
    State
        The last one.
    Survey
        All causes, estimated there.
    """
    taken: list[Found] = []
    for one in kept:
        candidate = one.after.fitted.active[-1]
        active = (*state.fitted.active, candidate)
        after = _settle(state.plain, state.model.processes, state.fitted, active, one.after.variances)
        taken.append(replace(one, before=state, after=after))
        state = _smoothed(after)
    return taken, state, survey(state, catalogue)


def _settle(
    plain: Joint, found: Processes, at: Fitted, active: tuple[Candidate, ...], variances: Vector
) -> State:
    """Law, causes and discrepancy fitted in turn from where they stand."""
    law, scales = at.law, at.scales
    for _ in range(SETTLED):
        noise = plain.noise.beside(found.beside(variances))
        wide = Joint(plain.observed, plain.base, noise)
        fitted = wide.fit(law, scales, active, CONVERGED)
        law, scales, active = fitted.law, fitted.scales, fitted.active
        linear = plain.linearise(law, scales, active)
        model = likelihood.reduce(found, linear)
        variances = likeliest(model, variances).variances
    return State(plain, wide, fitted, linear, model, variances)


def likeliest(model: Reduced, variances: Vector, cause: Direction | None = None) -> Estimate:
    """The likeliest of several answers.

    Which of three specimens is odd, or a phase that is off at every frequency for a modulus that is, may be told in two
    ways, and one start finds one of them.

    Parameters
    ----------
    model : Reduced
        Of `likelihood.reduce`.
    variances : ndarray (m,)
        Where to start, among other places.
    cause : Direction, optional
        One direction that is in the model, or none.

    Returns
    -------
    Estimate
        Of the least misfit.
    """
    uncommon = np.where(
        [one.kind == "all" for one in model.processes.described], discrepancy.LEAST, variances
    )
    tried = [likelihood.estimate(model, cause, start) for start in (variances, None, uncommon)]
    return min(tried, key=lambda estimate: estimate.misfit)


def _smoothed(state: State) -> State:
    """The same with the roughness of the law that is likeliest beside the discrepancy."""
    wide, fitted = of_likeliest_roughness(state.wide, state.fitted, CONVERGED)
    plain = Joint(state.plain.observed, wide.base, state.plain.noise)
    return _settle(plain, state.model.processes, fitted, fitted.active, state.variances)


def survey(state: State, catalogue: Sequence[Cause]) -> Survey:
    """Candidates that the table can show, each estimated beside the discrepancy.

    Parameters
    ----------
    state : State
        Where they are estimated.
    catalogue : sequence of Cause
        Causes.

    Returns
    -------
    Survey
        Of each candidate.
    """
    candidates, pointing = _pointing(state, catalogue)
    # In a large table the sizes are well determined, and each start takes a second.
    several = state.plain.observed.size <= SEVERAL_STARTS
    scored = _scored(state, pointing)
    promising = set(_promising(candidates, scored))
    estimates = [
        scored[k]
        if candidate.shaped and k not in promising
        else likeliest(state.model, state.variances, pointing.column(k))
        if several and not candidate.shaped
        else likelihood.estimate(state.model, pointing.column(k), state.variances)
        for k, candidate in enumerate(candidates)
    ]
    one_sided = np.array([c.cause.parameters[0].low >= 0.0 for c in candidates], bool)
    return Survey(candidates, pointing, estimates, one_sided)


def _scored(state: State, pointing: Direction) -> list[Estimate]:
    """Each candidate beside a discrepancy of the sizes that it has without, which no gain is told of."""
    information, score = likelihood.weighed(state.model, pointing, state.variances)
    least = np.maximum(np.diag(information), 1e-12)
    return [
        Estimate(state.variances, np.inf, float(amplitude), float(error))
        for amplitude, error in zip(score / least, least**-0.5, strict=True)
    ]


def _promising(candidates: Sequence[Candidate], scored: Sequence[Estimate]) -> Iterator[int]:
    """Of each cause with shapes of its own the STARTS that the table speaks for most."""
    best = np.argsort([-one.z for one in scored], kind="stable")
    count: dict[tuple, int] = {}
    for k in best.tolist():
        key = candidates[k].key
        count[key] = count.get(key, 0) + 1
        if candidates[k].shaped and count[key] <= STARTS:
            yield k


def _next(state: State, surveyed: Survey, draws: int, random: np.random.Generator) -> Found | None:
    candidates, estimates, one_sided = surveyed.candidates, surveyed.estimates, surveyed.one_sided
    if not candidates:
        return None
    nothing = likeliest(state.model, state.variances)
    z = np.array([estimate.z for estimate in estimates])
    z = np.where(one_sided, np.maximum(z, 0.0), np.abs(z))
    gains = np.array([nothing.misfit - estimate.misfit for estimate in estimates])
    by_chance = _by_chance(state, surveyed, draws, random)
    # A law fitted without the cause has followed it: what comes near is refitted before it is judged.
    least = float(np.quantile(by_chance, 1.0 - ALPHA_PER_STEP))
    large = bool((state.variances > HIDES**2).any())
    eligible = (z > NEAR * least) & (gains > NEAR * TWENTY_TIMES)
    shortlist: dict[tuple, list[int]] = {}
    for k in np.argsort(-np.where(eligible, gains, -np.inf)):
        key = candidates[k].key
        if eligible[k] and (key in shortlist or len(shortlist) < REFITS):
            shortlist.setdefault(key, []).append(int(k))
    # A discrepancy sized without an error of all phases may have taken it up whole.
    taken_up = {k for k, one in enumerate(candidates) if large and one.cause.stage == CHANNEL}
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
        active = (*state.fitted.active, candidates[k].with_values(values))
        after = _settle(state.plain, state.model.processes, state.fitted, active, estimates[k].variances)
        if k in taken_up:
            after = min(after, _afresh(state, active), key=lambda one: one.misfit)
        taken = after.fitted.active[-1]
        gain = state.misfit - after.misfit - of_shapes(after.fitted, taken, state.plain.observed)
        if gain > TWENTY_TIMES:
            own = of_taken(after, taken)
            z[k] = max(z[k], abs(own.z))
            if not _stands(state, after, taken, own):
                continue
            odds[k] = log_odds(taken, state.plain.observed, gain, own.std_error * float(taken.typical[0]))
            if z[k] > least:
                refits.append((gain, k, after))
    if not refits:
        return None
    most = max(gain for gain, _, _ in refits)
    as_good = [refit for refit in refits if most - refit[0] < TWENTY_TIMES]
    _, k, after = max(as_good, key=lambda refit: odds[refit[1]])
    rivals = tuple(other.fitted.active[-1] for _, j, other in as_good if j != k)
    share = dict(zip(odds, shares(list(odds.values())).tolist(), strict=True))
    if sum(share[j] for _, j, _ in as_good) < POSSIBLE:
        return None
    p_value = chance.tail(by_chance, float(z[k]))
    return Found(after.fitted.active[-1], p_value, state, after, rivals, share[k])


def _afresh(state: State, active: tuple[Candidate, ...]) -> State:
    """Law and causes fitted before there is a discrepancy, which else keeps what it took up without them."""
    laws = [state.fitted.law, *first_laws(state.plain)]
    fits = [state.plain.fit(law, state.fitted.scales, active, CONVERGED) for law in laws]
    fitted = min(fits, key=lambda one: one.objective)
    found = discrepancy.processes(state.plain, fitted)
    start = likelihood.estimate(likelihood.reduce(found, fitted)).variances
    return _settle(state.plain, found, fitted, fitted.active, start)


def _stands(before: State, state: State, taken: Candidate, own: Estimate) -> bool:
    """Whether a cause competes for the place of the next name: what does not takes no probability from one that does.

    Its size is not zero. One with shapes of its own follows almost any structure: it must be carried by the whole
    table, and its shapes must not be at the edge of what they may be.
    """
    if not taken.shaped:
        return bool(abs(own.z) >= CONFIDENCE)
    return not (taken.at_bounds or hangs_on(state, taken, before))


def _pointing(state: State, catalogue: Sequence[Cause]) -> tuple[list[Candidate], Direction]:
    """Candidates that are not taken yet and that the table can show, with their directions."""
    taken = {candidate.key for candidate in state.fitted.active}
    candidates = [
        c for c in chance.catalogue_candidates(state.plain.observed, catalogue) if c.key not in taken
    ]
    if not candidates:
        return [], Direction(np.zeros((state.model.along.size, 0)), np.zeros((0, 0)), np.zeros(0))
    d = state.plain.noise.whiten(chance.candidate_directions(state.plain, state.fitted, candidates))
    pointing = likelihood.directions(state.model, state.linear, d)
    # A law that was fitted without a spring has followed it and leaves little of its direction: a fit with the spring
    # decides. It may follow all of most others, as a shift may of an error of temperature.
    fitted = [isinstance(c.place, str) or c.cause.name == "guide_stiffness" for c in candidates]
    least = np.where(fitted, FOLLOWED, ABSORBED)
    left, size = np.diag(pointing.own), (d**2).sum(axis=0)
    seen = np.flatnonzero(left > least * np.maximum(size, 1e-300))
    kept = Direction(pointing.cross[:, seen], pointing.own[np.ix_(seen, seen)], pointing.along[seen])
    return [candidates[k] for k in seen], kept


def _by_chance(state: State, surveyed: Survey, draws: int, random: np.random.Generator) -> Vector:
    correlation, _ = likelihood.correlation(state.model, surveyed.pointing, state.variances)
    k = surveyed.one_sided.size
    scores = Scores(np.zeros(k), np.ones(k), np.ones(k, bool), correlation)
    return chance.largest_by_chance(scores, surveyed.one_sided, state.plain.noise.freedom, draws, random)


def of_taken(
    state: State, candidate: Candidate, rows: NDArray | None = None, sizes_too: bool = False
) -> Estimate:
    """Amplitude of a cause that is in the fit, in typical units, from all rows or from some.

    sizes_too: whether its standard error holds what is not known of the discrepancy's sizes.
    """
    first = state.fitted.law.size + state.fitted.scales.size
    for active in state.fitted.active:
        if active.key == candidate.key:
            break
        first += len(active.values)
    plain, model, linear = state.plain, state.model, state.linear
    if rows is not None:
        plain = Joint(plain.observed.subset(rows), plain.base, plain.noise.subset(rows))
        linear = plain.linearise(state.fitted.law, state.fitted.scales, state.fitted.active)
    d = linear.jacobian[:, [first]]
    rest = replace(
        linear,
        jacobian=np.delete(linear.jacobian, first, axis=1),
        precision=np.delete(np.delete(linear.precision, first, axis=0), first, axis=1),
        gradient=np.delete(linear.gradient, first),
    )
    found, start = model.processes, state.variances
    if rows is not None:
        found, start = _of_rows(found, plain, rows, start)
    model = likelihood.reduce(found, rest)
    pointing = likelihood.directions(model, rest, d)
    found_value = likelihood.estimate(model, pointing, start)
    if sizes_too:
        found_value = likelihood.with_uncertain_sizes(model, pointing, found_value)
    stands = active.values[0] / active.typical[0]
    return replace(found_value, amplitude=found_value.amplitude + stands)


def _of_rows(found: Processes, plain: Joint, rows: NDArray, variances: Vector) -> tuple[Processes, Vector]:
    """The processes of some rows, those that reach none of them left out."""
    kept = [k for k, root in enumerate(found.roots) if np.abs(root[rows]).max() > 0.0]
    roots = tuple(found.roots[k][rows] for k in kept)
    factor = np.hstack([plain.noise.whiten(root) for root in roots])
    block = np.repeat(np.arange(len(kept)), [root.shape[1] for root in roots])
    described = tuple(found.described[k] for k in kept)
    return (
        Processes(described, roots, factor, block, found.usual[kept], found.spread[kept]),
        variances[kept],
    )


def of_shapes(fitted: Fitted, candidate: Candidate, observed: Observations) -> float:
    """What the freedom of a cause's shapes costs: -2 ln of the share of their prior that tests leave them (Laplace).

    The prior is about as wide as the fit's about each start. The share is that given the amplitude, whose own error is
    counted with its own prior.
    """
    if not candidate.shaped:
        return 0.0
    first = fitted.law.size + fitted.scales.size
    for active in fitted.active:
        if active.key == candidate.key:
            break
        first += len(active.values)
    at = slice(first, first + len(candidate.values))
    own = fitted.covariance[at, at]
    left = float(np.linalg.slogdet(own)[1] - np.log(own[0, 0]))
    starts = np.ptp(np.array(candidate.cause.shapes(observed)), axis=0) / candidate.typical[1:]
    return float((2.0 * np.log1p(starts / np.sqrt(2.0 * np.pi))).sum()) - left


def hangs_on(state: State, candidate: Candidate, before: State | None = None) -> list[str]:
    """What must not be left out for a cause to be seen.

    A cause with shapes of its own is judged by what it gains over a fit without it: its shapes make its size
    uncertain long before they make it doubtful that there is one.

    Parameters
    ----------
    state : State
        With the cause.
    candidate : Candidate
        The cause.
    before : State, optional
        The fit without it, made here if not given.

    Returns
    -------
    list of str
        Isotherms, frequencies, specimens; best none.
    """
    observed = state.plain.observed
    sign, carried = np.sign(candidate.values[0]), []
    if candidate.shaped and before is None:
        before = with_causes(state, tuple(one for one in state.fitted.active if one.key != candidate.key))
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
                lost = sign * of_taken(state, candidate, rows).z < SURVIVES
            if lost:
                carried.append(words(value))
    return carried


def _misfit_of(state: State, rows: NDArray) -> float:
    """-2 ln of the likelihood of some rows, as `State.misfit`: one step of law and causes, the sizes estimated anew."""
    plain = Joint(state.plain.observed.subset(rows), state.plain.base, state.plain.noise.subset(rows))
    linear = plain.linearise(state.fitted.law, state.fitted.scales, state.fitted.active)
    found, start = _of_rows(state.model.processes, plain, rows, state.variances)
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
    return left[name] > (0 if name == "specimen" else 1)


def estimates(state: State, surveyed: Survey) -> dict[tuple, tuple[float, float]]:
    """Amplitude of every cause at every place.

    Of a cause that is in the fit, and of each other as if it were the next one. Of several shapes, the one
    that the table sees best.

    Parameters
    ----------
    state : State
        The last one.
    surveyed : Survey
        All causes, estimated there.

    Returns
    -------
    dict of tuple to tuple of float
        Amplitude and standard error in physical units, by cause and place.
    """
    out: dict[tuple, tuple[float, float]] = {}
    for active in state.fitted.active:
        own = of_taken(state, active, sizes_too=True)
        out[active.key] = (own.amplitude * active.typical[0], own.std_error * active.typical[0])
    best: dict[tuple, int] = {}
    for k, candidate in enumerate(surveyed.candidates):
        other = best.setdefault(candidate.key, k)
        if surveyed.estimates[k].std_error < surveyed.estimates[other].std_error:
            best[candidate.key] = k
    for key, k in best.items():
        typical, direction = surveyed.candidates[k].typical[0], surveyed.pointing.column(k)
        one = likelihood.with_uncertain_sizes(state.model, direction, surveyed.estimates[k])
        out[key] = (one.amplitude * typical, one.std_error * typical)
    return out


def _named_from(state: State, surveyed: Survey, k: int, threshold: float) -> float:
    """Amplitude, in typical units, that gets its name beside a discrepancy in 19 of 20 cases.

    The effect is put into this table, less its own value of it: the discrepancy may take up what it can.
    """
    candidate = surveyed.candidates[k]
    typical = float(candidate.typical[0])
    one, direction = surveyed.estimates[k], surveyed.pointing.column(k)
    amplitude = (threshold + Z_95) * one.std_error
    for _ in range(LARGER):
        seen = amplitude - Z_95 * one.std_error
        model, pointing = likelihood.moved(state.model, direction, seen - one.amplitude)
        without = likeliest(model, state.variances).misfit
        gain = without - likelihood.estimate(model, pointing, one.variances).misfit
        gain -= _shapes_at(state, candidate, amplitude)
        # A name asks for both: a gain over the discrepancy, and odds over none that hold what is usual of the cause.
        present = candidate.with_values(np.array([amplitude * typical, *candidate.values[1:]]))
        odds = log_odds(present, state.plain.observed, gain, one.std_error * typical)
        if gain > TWENTY_TIMES and odds > logit(POSSIBLE):
            break
        amplitude *= 1.25
    return amplitude


def _shapes_at(state: State, candidate: Candidate, amplitude: float) -> float:
    """`of_shapes` of a cause of this amplitude [typical units], were it in the fit."""
    if not candidate.shaped:
        return 0.0
    most = min(amplitude * candidate.typical[0], candidate.cause.parameters[0].high)
    present = candidate.with_values(np.array([most, *candidate.values[1:]]))
    active = (*state.fitted.active, present)
    fitted = state.wide.linearise(state.fitted.law, state.fitted.scales, active)
    return of_shapes(fitted, present, state.plain.observed)


def detection_limits(
    state: State, surveyed: Survey, draws: int, random: np.random.Generator
) -> tuple[dict[tuple, float], list[Candidate], list[tuple[Candidate, Candidate]]]:
    """Limits beside the discrepancy of this table.

    Parameters
    ----------
    state : State
        The last one.
    surveyed : Survey
        All causes, estimated there.
    draws : int
        Of the chance level.
    random : Generator
        Whence.

    Returns
    -------
    dict of tuple to float
        By cause and place.
    list of Candidate
        Causes never seen in it.
    list of tuple of Candidate
        Pairs that look alike.
    """
    sizes: dict[tuple, float] = {}
    unseen: list[Candidate] = []
    alike: list[tuple[Candidate, Candidate]] = []
    taken_up: set[tuple] = set()
    threshold = USUAL_THRESHOLD
    if surveyed.candidates:
        threshold = float(np.quantile(_by_chance(state, surveyed, draws, random), 1.0 - ALPHA_PER_STEP))
        correlation, errors = likelihood.correlation(state.model, surveyed.pointing, state.variances)
        # A cause with shapes of its own must be carried by the whole table: no size says that beside a discrepancy.
        alone = bool((state.variances < HIDES**2).all())
        simple = np.array([alone or len(candidate.values) == 1 for candidate in surveyed.candidates])
        shapes: dict[tuple, list[int]] = {}
        for k, candidate in enumerate(surveyed.candidates):
            shapes.setdefault(candidate.key, []).append(k)
        for group in shapes.values():
            # Of several shapes the one that most of them exceed stands for all.
            k = sorted(group, key=lambda j: errors[j])[int(limits.MOST * (len(group) - 1))]
            needed = _named_from(state, surveyed, k, threshold) / (threshold + Z_95)
            # In reach but for the discrepancy, which takes up all that is physical: the table shows none.
            most = surveyed.candidates[k].cause.parameters[0].high / surveyed.candidates[k].typical[0]
            if surveyed.estimates[k].std_error <= most / (threshold + Z_95) < needed:
                taken_up.add(surveyed.candidates[k].key)
            at_least = errors[k] if len(group) > 1 else surveyed.estimates[k].std_error
            errors[group] *= max(at_least, needed) / errors[k]
            simple[group] &= np.array(group) == k  # to refit the law beside each shape would take seconds
        found = Scores(np.zeros(errors.size), errors**-2, simple, correlation)
        sizes, unseen = limits.detection_limits(
            state.wide, state.fitted, surveyed.candidates, found, threshold + Z_95
        )
        hidden = {one.key: one for one in surveyed.candidates if one.key in taken_up & sizes.keys()}
        unseen += hidden.values()
        sizes = {key: size for key, size in sizes.items() if key not in hidden}
        every = replace(found, seen=np.ones(errors.size, bool))
        alike = limits.alike(surveyed.candidates, every, TWENTY_TIMES)
    for active in state.fitted.active:
        own = of_taken(state, active)
        sizes[active.key] = (threshold + Z_95) * own.std_error * float(active.typical[0])
    return sizes, unseen, alike
