"""Several campaigns of one machine: what its channels and its head do to all of them, the mixes free.

Each campaign has its own law, specimens, scatter and discrepancy. Near its fit the amplitudes a of the machine's causes
enter as -2 ln L = a^T I a - 2 a^T s, I and s with the law, the specimens and the discrepancy integrated out. Campaigns
are independent, so I and s add up (a meta-analysis of individual data). Where campaigns differ by more than their
errors, that widens the answer (DerSimonian and Laird 1986); one that is astray does not carry it. A name has rivals
without one: the same effect with a size of its own on each isotherm, or at each frequency.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from asphalt_nscd.diagnosis import criteria
from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause
from asphalt_nscd.diagnosis.machine.common_faults import Common, Part, Pooled
from asphalt_nscd.diagnosis.model import chance, fit_beside, laboratory, likelihood
from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed.observations import Observations, Vector
from asphalt_nscd.diagnosis.search import limits, one_search
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.search.ladder import spread_of
from asphalt_nscd.diagnosis.settings import Draws
from asphalt_nscd.diagnosis.written import widening


def is_machine_cause(cause: Cause) -> bool:
    """Whether a cause has one parameter, of head or channel, the same in all tests of a machine."""
    # Amplitudes add up over campaigns; the shapes of a cause would not.
    return cause.stage >= HEAD and not cause.confined_to and len(cause.parameters) == 1


MACHINE = frozenset(cause.name for cause in CATALOGUE if is_machine_cause(cause))
OF_TESTS = tuple(cause for cause in CATALOGUE if cause.alters_tests)
FARTHEST = 30.0  # standard errors, from which on all campaigns count as equally far
ITERATIONS = 30  # of the mixture of sound campaigns and those astray
SETTLED = 2  # fits with the causes of the machine at their pooled size


@dataclass(frozen=True)
class _Campaign:
    name: str
    state: fit_beside.State
    spread: float  # factor on its errors, as its own diagnosis tells them

    def refit_campaign(self, causes: Sequence[Cause], amplitudes: Vector) -> _Campaign:
        """Fitted with the causes at these amplitudes [typical units] as a start."""
        own = tuple(one for one in self.state.fitted.active if not is_machine_cause(one.cause))
        added = tuple(
            Candidate(cause, None, (amplitude * cause.parameters[0].typical,))
            for cause, amplitude in zip(causes, amplitudes, strict=True)
            if cause.places(self.state.plain.observed)
        )
        return replace(self, state=fit_beside.refit_causes(self.state, (*own, *added)))

    def judged_beside(self, causes: Sequence[Cause], amplitudes: Vector) -> _Campaign:
        """Fitted so, with the spread that is left beside causes of the machine: what is common to all campaigns is no
        reason to believe each of them less.
        """
        state = self.refit_campaign(causes, amplitudes).state
        estimates = limits.estimates(state, one_search.survey(state, OF_TESTS))
        named = {one.cause.name for one in state.fitted.active} | MACHINE
        return replace(self, spread=widening(spread_of(estimates, named)))


@dataclass(frozen=True)
class _Evidence:
    """information (k, k) and score (k,) of k directions, amplitudes in typical units from zero."""

    information: NDArray
    score: Vector

    def conditional(self, kept: Sequence[int], held: Mapping[int, float]) -> _Evidence:
        """Evidence of some of the causes, others held at a value."""
        at = list(kept)
        score = self.score[at].copy()
        for k, value in held.items():
            score -= self.information[at, k] * value
        return _Evidence(self.information[np.ix_(at, at)], score)


def pool(campaigns: Mapping[str, Diagnosis], draws: int = Draws.number, seed: int = Draws.seed) -> Pooled:
    """Find what the campaigns have in common; `draws` are those of the chance level."""
    random = np.random.default_rng(seed)
    begun = {name: _begin(name, diagnosis) for name, diagnosis in campaigns.items()}
    states = [one for one in begun.values() if one is not None]
    found: list[Common] = []
    causes: list[Cause] = []
    amplitudes = np.zeros(0)
    limits: dict[str, float] = {}
    while states:
        tables = [one.state.plain.observed for one in states]
        left = [cause for cause in CATALOGUE if is_machine_cause(cause) and cause not in causes]
        open_ = [cause for cause in left if any(map(cause.places, tables))]
        if not open_:
            break
        each = {cause: [_evidence(one, [*causes, cause]) for one in states] for cause in open_}
        pooled = {cause: _together(each[cause], amplitudes) for cause in open_}
        first = max(open_, key=lambda cause: _z(cause, pooled[cause]))
        # An offset of the machine inflates the spread by which each campaign is believed less: 1.25 to 1.7, not 1.0.
        beside = np.append(amplitudes, pooled[first].value)
        states = [one.judged_beside([*causes, first], beside) for one in states]
        each = {cause: [_evidence(one, [*causes, cause]) for one in states] for cause in open_}
        pooled = {cause: _together(each[cause], amplitudes) for cause in open_}
        by_chance = _largest_by_chance(states, [*causes, *open_], len(causes), draws, random)
        threshold = float(np.quantile(by_chance, 1.0 - criteria.ALPHA_OF_MACHINE))
        for cause in open_:
            size = (threshold + criteria.Z_95) * pooled[cause].std_error * cause.parameters[0].typical
            limits.setdefault(cause.name, size)
        z_of = {cause: _z(cause, pooled[cause]) for cause in open_}
        common = [cause for cause in open_ if z_of[cause] > threshold]
        if not common or len(causes) == criteria.MOST_OF_MACHINE:
            break
        gains = {cause: _gain(each[cause], amplitudes) for cause in common}
        best = _likeliest(pooled, gains, len(states))
        z = z_of[best]
        near = [cause for cause in open_ if z**2 - z_of[cause] ** 2 < criteria.TWENTY_TIMES]
        causes.append(best)
        amplitudes = np.append(amplitudes, pooled[best].value)
        p_value = chance.tail(by_chance, z)
        for _ in range(SETTLED):
            states = [one.refit_campaign(causes, amplitudes) for one in states]
            amplitudes = _all_together([_evidence(one, causes) for one in states], amplitudes)
        as_good = tuple(cause.name for cause in near if cause is not best)
        found.append(Common(best, p_value, as_good))
    last = [_evidence(one, causes) for one in states]
    found = [_told(one, k, states, last, causes, amplitudes) for k, one in enumerate(found)]
    # What was found beside a cause that has no one size hangs on it: it is not told.
    nameless = next((k for k, one in enumerate(found) if not one.named), len(found))
    left_out = tuple(name for name, one in begun.items() if one is None)
    return Pooled(tuple(found[: nameless + 1]), limits, left_out)


def _begin(name: str, diagnosis: Diagnosis) -> _Campaign | None:
    """A campaign without any cause of the machine; what it holds of its own stays."""
    ladder = diagnosis.ladder
    base = ladder.joint.base
    if not isinstance(base, FlexibleSpectrum) or diagnosis.observed.isotherms.size < 2:
        return None
    plain = laboratory.alone(Joint(diagnosis.observed, base, diagnosis.alone))
    own = tuple(one for one in ladder.fitted.active if not is_machine_cause(one.cause))
    fitted = plain.fit(ladder.fitted.law, ladder.fitted.scales, own)
    spread = spread_of(ladder.estimates, MACHINE | {rung.candidate.cause.name for rung in ladder.rungs})
    return _Campaign(name, fit_beside.begin(plain, fitted), widening(spread))


def _evidence(campaign: _Campaign, causes: Sequence[Cause], parts: NDArray | None = None) -> _Evidence:
    """What a campaign says of the amplitudes of causes, the discrepancy estimated beside the last of them.

    With `parts` (n, k), the share of each test in k parts: of the last cause alone, with an amplitude in each part.
    """
    state, observed = campaign.state, campaign.state.plain.observed
    size, shown = len(causes), [k for k, cause in enumerate(causes) if cause.places(observed)]
    if not shown:
        return _Evidence(np.zeros((size, size)), np.zeros(size))
    columns, stands, places = zip(*(_direction(state, causes[k]) for k in shown), strict=True)
    rest = state.linear.fixed([place for place in places if place is not None])
    model = likelihood.reduce(state.model.processes, rest)
    pointing = likelihood.directions(model, rest, state.plain.noise.whiten(np.column_stack(columns)))
    # Those before the last are held at where they stand: their size is common and known far better.
    variances = fit_beside.likeliest(model, state.variances, pointing.column(len(shown) - 1)).variances
    if parts is not None:
        apart = columns[-1][:, None] * parts
        pointing = likelihood.directions(model, rest, state.plain.noise.whiten(apart))
    information, score = likelihood.weighed(model, pointing, variances)
    # A campaign whose estimates spread further than they say counts for less, as in its own intervals.
    information, score = information / campaign.spread**2, score / campaign.spread**2
    if parts is not None:
        return _Evidence(information, score + information @ np.full(parts.shape[1], stands[-1]))
    whole, out, at = np.zeros((size, size)), np.zeros(size), np.zeros(size)
    whole[np.ix_(shown, shown)], out[shown], at[shown] = information, score, stands
    return _Evidence(whole, out + whole @ at)


def _direction(state: fit_beside.State, cause: Cause) -> tuple[NDArray, float, int | None]:
    """Derivative (n,) of ln E* along a cause, its value in the fit [typical units] and its place in the Jacobian."""
    fitted, joint = state.fitted, state.plain
    for k, one in enumerate(fitted.active):
        if one.key == (cause.name, None):
            column = joint.direction(fitted.law, fitted.scales, fitted.active, k, 0)
            return column, one.values[0] / cause.parameters[0].typical, fitted.place_of(one.key)
    absent = (*fitted.active, Candidate(cause, None, (0.0,)))
    return joint.direction(fitted.law, fitted.scales, absent, len(absent) - 1, 0), 0.0, None


def _all_together(each: Sequence[_Evidence], start: Vector) -> Vector:
    """Amplitudes (k,) of all causes at once, by weighted least squares; an amplitude that no campaign shows stays."""
    information = np.sum([one.information for one in each], axis=0)
    score = np.sum([one.score for one in each], axis=0)
    seen = np.diag(information) > 0.0
    out = start.copy()
    out[seen] = np.linalg.solve(information[np.ix_(seen, seen)], score[seen])
    return out


@dataclass(frozen=True)
class _Whole:
    """One amplitude of all campaigns [typical units]; z: its size in standard errors, by the likelihood ratio."""

    value: float = 0.0
    std_error: float = np.inf
    z: float = 0.0
    differ: float = 1.0  # chance that campaigns differ so much


def _together(each: Sequence[_Evidence], taken: Vector) -> _Whole:
    """The last cause from all campaigns; taken (k - 1,): amplitudes of those before it.

    Where campaigns differ by more than chance, that widens the error; else one in ten may be in error by more than it
    says.
    """
    last = taken.size
    alone = [one.conditional([last], dict(enumerate(taken))) for one in each]
    weight = np.array([float(one.information[0, 0]) for one in alone])
    shown = weight > 0.0
    if not shown.any():
        return _Whole()
    value = np.array([float(one.score[0]) for one in alone])[shown] / weight[shown]
    weight = weight[shown]
    # The others are free too: what they leave of the information of this one.
    whole = np.sum([one.information for one in each], axis=0)
    free = float(1.0 / np.linalg.inv(whole)[last, last]) / whole[last, last] if last else 1.0
    mean = float(weight @ value / weight.sum())
    square, freedom = float(weight @ (value - mean) ** 2), weight.size - 1
    # Cochran's Q: chi-squared where one size holds for all.
    differ = float(chdtrc(freedom, square)) if freedom else 1.0
    if differ < criteria.DIFFERENT:
        # Moments (DerSimonian & Laird 1986): the variance between campaigns, above what their errors make.
        excess = (square - freedom) / (weight.sum() - float(weight @ weight) / weight.sum())
        wide = 1.0 / (1.0 / weight + excess)
        mean, error = float(wide @ value / wide.sum()), float((wide.sum() * free) ** -0.5)
        return _Whole(mean, error, mean / error, differ)
    # A mixture of sound campaigns and those astray, by EM: one far off keeps 1/LARGER^2 of its weight.
    for _ in range(ITERATIONS):
        sound, astray = _densities(value - mean, weight)
        pulled = weight * (1.0 - astray / (sound + astray) * (1.0 - criteria.LARGER**-2))
        mean = float(pulled @ value / pulled.sum())
    error = float((pulled.sum() * free) ** -0.5)
    # A mixture is not normal: its likelihood ratio says how sure the mean is, not mean over error.
    ratio = 2.0 * free * (_log_likelihood(value - mean, weight) - _log_likelihood(value, weight))
    return _Whole(mean, error, float(np.sign(mean) * np.sqrt(max(ratio, 0.0))), differ)


def _log_likelihood(left: Vector, weight: Vector) -> float:
    return float(np.log(_densities(left, weight).sum(axis=0)).sum())


def _densities(left: Vector, weight: Vector) -> Vector:
    """Densities (2, n) of departures `left` (n,) by sound campaigns and by those astray, up to a factor."""
    # Farther out both densities would underflow, and no share of either be left.
    z = np.minimum(np.sqrt(weight) * np.abs(left), FARTHEST)
    sound, wrong = np.exp(-0.5 * z**2), np.exp(-0.5 * (z / criteria.LARGER) ** 2)
    return np.array([(1.0 - criteria.ASTRAY) * sound, criteria.ASTRAY / criteria.LARGER * wrong])


def _likeliest(pooled: Mapping[Cause, _Whole], gains: Mapping[Cause, float], campaigns: int) -> Cause:
    """The likeliest cause by -2 ln likelihood: of one size, or with a size in each campaign, which costs two each."""

    def worth(cause: Cause) -> float:
        one = pooled[cause]
        return one.z**2 if one.differ >= criteria.DIFFERENT else gains[cause] - 2.0 * (campaigns - 1)

    return max(gains, key=worth)


def _gain(each: Sequence[_Evidence], taken: Vector) -> float:
    """What -2 ln likelihood falls by with the last cause, of an amplitude of its own in each campaign."""
    alone = [one.conditional([taken.size], dict(enumerate(taken))) for one in each]
    shown = [one for one in alone if one.information[0, 0] > 0.0]
    return sum(float(one.score[0] ** 2 / one.information[0, 0]) for one in shown)


def _z(cause: Cause, found: _Whole) -> float:
    """Size in standard errors; zero where a one-sided cause has the sign that it cannot have."""
    return max(found.z, 0.0) if cause.one_sided else abs(found.z)


def _largest_by_chance(
    states: Sequence[_Campaign], causes: Sequence[Cause], taken: int, draws: int, random: np.random.Generator
) -> Vector:
    """The largest z of the causes after the first `taken` that chance alone gives."""
    information = np.sum([_evidence(one, causes).information for one in states], axis=0)
    own = information[taken:, taken:]
    if taken:
        # What is taken already stays free, and takes its part of the others' information.
        cross = information[taken:, :taken]
        own = own - cross @ np.linalg.solve(information[:taken, :taken], cross.T)
    size = np.sqrt(np.maximum(np.diag(own), 1e-300))
    one_sided = np.array([cause.one_sided for cause in causes[taken:]])
    freedom = sum(one.state.plain.noise.freedom for one in states)
    return chance.largest_by_chance(own / size[:, None] / size, one_sided, freedom, draws, random)


def _told(
    one: Common,
    k: int,
    states: Sequence[_Campaign],
    last: Sequence[_Evidence],
    causes: Sequence[Cause],
    amplitudes: Vector,
) -> Common:
    """A cause with its size beside all others, and from each campaign, isotherm and frequency alone."""
    order = [*(j for j in range(len(causes)) if j != k), k]
    each = [one_.conditional(order, {}) for one_ in last]
    others = amplitudes[order[:-1]]
    whole = _together(each, others)
    unit = one.cause.parameters[0].typical
    alone = [one_.conditional([len(order) - 1], dict(enumerate(others))) for one_ in each]
    campaigns = tuple(_part(of.name, evidence, unit) for of, evidence in zip(states, alone, strict=True))
    ordered = [causes[j] for j in order]
    isotherms, by_isotherm = _apart(states, ordered, lambda of: of.isotherm, "degC")
    frequencies, by_frequency = _apart(states, ordered, lambda of: of.frequency, "Hz")
    tested = {"campaigns": whole.differ, "isotherms": by_isotherm, "frequencies": by_frequency}
    return replace(
        one,
        value=whole.value * unit,
        std_error=whole.std_error * unit,
        campaigns=campaigns,
        isotherms=isotherms,
        frequencies=frequencies,
        differs={name: p_value for name, p_value in tested.items() if p_value < criteria.DIFFERENT},
    )


def _part(name: str, evidence: _Evidence, unit: float) -> Part:
    weight = float(evidence.information[0, 0])
    if weight <= 0.0:
        return Part(name, np.nan, np.nan)
    return Part(name, float(evidence.score[0]) / weight * unit, weight**-0.5 * unit)


def _apart(
    states: Sequence[_Campaign], causes: Sequence[Cause], label: Callable[[Observations], Vector], word: str
) -> tuple[tuple[Part, ...], float]:
    """The last cause with an amplitude of its own at each label, and the chance that one amplitude differs so much."""
    labels = np.unique(np.concatenate([label(one.state.plain.observed) for one in states]))
    size = labels.size
    information, score = np.zeros((size, size)), np.zeros(size)
    for one in states:
        if causes[-1].places(one.state.plain.observed):
            parts = (label(one.state.plain.observed)[:, None] == labels).astype(float)
            evidence = _evidence(one, causes, parts)
            information, score = information + evidence.information, score + evidence.score
    seen = np.diag(information) > 0.0
    precision = information[np.ix_(seen, seen)]
    covariance = np.linalg.pinv(precision, hermitian=True)
    value = covariance @ score[seen]
    unit = causes[-1].parameters[0].typical
    error = np.sqrt(np.maximum(np.diag(covariance), 0.0)) * unit
    each = zip(labels[seen], value * unit, error, strict=True)
    told = tuple(Part(f"{name:g} {word}", float(v), float(std_error)) for name, v, std_error in each)
    together = np.ones(value.size)
    whole = float(together @ precision @ together)
    mean = float(together @ score[seen]) / whole if whole > 0.0 else 0.0
    square = float((value - mean) @ precision @ (value - mean))
    return told, float(chdtrc(value.size - 1, square)) if value.size > 1 else 1.0
