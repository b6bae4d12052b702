"""What a table could have shown: the detection limit of each cause, and causes that look alike in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray
from scipy.special import logit

from asphalt_nscd.diagnosis.causes._cause import Setting
from asphalt_nscd.diagnosis.criteria import (
    ALPHA_PER_STEP,
    HIDES,
    NEARLY_SURE,
    POSSIBLE,
    TWENTY_TIMES,
    USUAL_THRESHOLD,
    Z_95,
)
from asphalt_nscd.diagnosis.model import chance, likelihood
from asphalt_nscd.diagnosis.model.chance import Scores
from asphalt_nscd.diagnosis.model.fit_beside import (
    State,
    answers,
    taken_amplitude,
)
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.model.probability import log_odds
from asphalt_nscd.diagnosis.model.start import fit_roughness
from asphalt_nscd.diagnosis.search.one_search import Survey, largest_by_chance

Vector = NDArray[np.float64]
CLOSE = 0.05  # share of a direction left by the law, below which the law is refitted to see what it follows
AT_LEAST = 0.5  # share of the strength that must survive the refit
MOST = 0.9  # of the shapes of a cause
HIDDEN = 5.0  # typical sizes, where the search begins for an error of temperature that the shift follows
CONVERGED = 0.01  # change of the objective at which such a refit ends
STRONGEST = 3.0 * (USUAL_THRESHOLD + Z_95)  # three times a usual limit
RAISED, TIMES = (
    (0.05, 0.5),
    6,
)  # share by which a limit is raised where processes take the effect up; how often
CARRIED = (
    2.0  # of the linear limit of a cause with shapes of its own, which must be carried by the whole table
)
# Discrepancy and laboratory take up a part of each fault of one place, which a linear limit leaves out. Of 12 faults at
# it in four invented tables 6 were told; 4 of the others were told at half as much again, 2 in a table of two specimens
# were not.
TAKEN_UP = 1.6


def estimates(state: State, surveyed: Survey) -> dict[tuple, tuple[float, float]]:
    """Amplitude and standard error, in physical units, of every cause at every place.

    Of a cause that is in the fit, and of each other as if it were the next one, but for faults of one specimen or
    isotherm. Of several shapes, the one that the table sees best.
    """
    out: dict[tuple, tuple[float, float]] = {}
    for active in state.fitted.active:
        own = taken_amplitude(state, active, sizes_too=True)
        out[active.key] = (own.amplitude * active.typical[0], own.std_error * active.typical[0])
    best: dict[tuple, int] = {}
    for k, candidate in enumerate(surveyed.candidates):
        # Of faults of one place, only those of a frequency are asked for without being in the fit (`odd_frequency`).
        if candidate.cause.told and not isinstance(candidate.place, Setting):
            continue
        other = best.setdefault(candidate.key, k)
        if surveyed.estimates[k].std_error < surveyed.estimates[other].std_error:
            best[candidate.key] = k
    for key, k in best.items():
        typical, direction = surveyed.candidates[k].typical[0], surveyed.pointing.column(k)
        one = likelihood.widen_error(state.model, direction, surveyed.estimates[k])
        out[key] = (one.amplitude * typical, one.std_error * typical)
    return out


def _named_from(state: State, surveyed: Survey, k: int, threshold: float) -> float:
    """Amplitude, in typical units, that gets its name beside a discrepancy in 19 of 20 cases.

    The effect is put into this table, less its own value of it: the discrepancy may take up what it can.
    """
    candidate = surveyed.candidates[k]
    typical = float(candidate.typical[0])
    one, direction = surveyed.estimates[k], surveyed.pointing.column(k)
    amplitude, last = (threshold + Z_95) * one.std_error, list[Vector]()
    for _ in range(TIMES):
        seen = amplitude - Z_95 * one.std_error
        model, pointing = likelihood.moved(state.model, direction, seen - one.amplitude)
        beside = likelihood.estimate(model, pointing, one.variances).misfit
        # A name asks for both: a gain over the discrepancy, and odds over none that hold what is usual of the cause.
        present = candidate.replace_values(np.array([amplitude * typical, *candidate.values[1:]]))
        odds = log_odds(present, state.plain.observed, 0.0, one.std_error * typical)
        needed = max(TWENTY_TIMES, 2.0 * (float(logit(POSSIBLE)) - odds))
        # The first answer without the cause that does as well settles it: that of the last size most often does, the
        # slowest start comes last.
        again = (likelihood.estimate(model, None, start) for start in last)
        tried = chain(again, answers(model, state.variances))
        less = next((other for other in tried if other.misfit - beside < needed), None)
        if less is None:
            break
        last, gain = [less.variances], less.misfit - beside
        # What is seen gains by its square, once it is beyond what the processes take up.
        amplitude += seen * float(np.clip(np.sqrt(needed / max(gain, 1e-3)) - 1.0, *RAISED))
    return amplitude


def chance_threshold(state: State, surveyed: Survey, draws: int, random: np.random.Generator) -> float:
    """Score that the largest of a survey passes by chance in few of `draws` tables; a usual one of an empty survey."""
    if not surveyed.candidates:
        return USUAL_THRESHOLD
    return float(np.quantile(largest_by_chance(state, surveyed, draws, random), 1.0 - ALPHA_PER_STEP))


def detection_limits(
    state: State, surveyed: Survey, threshold: float
) -> tuple[dict[tuple, float], list[Candidate], list[tuple[Candidate, Candidate]]]:
    """Limits beside this table's discrepancy by cause and place, causes never seen in it, and pairs that look alike."""
    sizes: dict[tuple, float] = {}
    unseen: list[Candidate] = []
    alike: list[tuple[Candidate, Candidate]] = []
    taken_up: set[tuple] = set()
    if surveyed.candidates:
        correlation, errors = likelihood.correlation(state.model, surveyed.pointing, state.variances)
        # A cause with shapes of its own must be carried by the whole table: no size says that beside a discrepancy.
        alone = bool((state.hidden < HIDES**2).all())
        simple = np.array([alone or len(candidate.values) == 1 for candidate in surveyed.candidates])
        shapes: dict[tuple, list[int]] = {}
        for k, candidate in enumerate(surveyed.candidates):
            shapes.setdefault(candidate.key, []).append(k)
        for group in shapes.values():
            # Of several shapes the one that most of them exceed stands for all.
            k = sorted(group, key=lambda j: errors[j])[int(MOST * (len(group) - 1))]
            if surveyed.candidates[k].shaped:
                needed = CARRIED * float(errors[k])
            else:
                needed = _named_from(state, surveyed, k, threshold) / (threshold + Z_95)
            # In reach but for the discrepancy, which takes up all that is physical: the table shows none.
            most = (
                surveyed.candidates[k].cause.largest(state.plain.observed) / surveyed.candidates[k].typical[0]
            )
            if surveyed.estimates[k].std_error <= most / (threshold + Z_95) < needed:
                taken_up.add(surveyed.candidates[k].key)
            at_least = errors[k] if len(group) > 1 else surveyed.estimates[k].std_error
            errors[group] *= max(at_least, needed) / errors[k]
            simple[group] &= np.array(group) == k  # to refit the law beside each shape would take seconds
        found = Scores(np.zeros(errors.size), errors**-2, simple, correlation)
        sizes, unseen = _scored_limits(state.wide, state.fitted, surveyed.candidates, found, threshold + Z_95)
        hidden = {one.key: one for one in surveyed.candidates if one.key in taken_up & sizes.keys()}
        unseen += hidden.values()
        sizes = {key: size for key, size in sizes.items() if key not in hidden}
        alike = _alike(surveyed.candidates, correlation)
    for active in (one for one in state.fitted.active if not one.cause.told):
        own = taken_amplitude(state, active)
        sizes[active.key] = (threshold + Z_95) * own.std_error * float(active.typical[0])
    return sizes, unseen, alike


def _scored_limits(
    joint: Joint, fitted: Fitted, candidates: Sequence[Candidate], found: Scores, threshold: float
) -> tuple[dict[tuple, float], list[Candidate]]:
    """Amplitude found with 95 % probability by cause and place (enough for most shapes seen); causes never seen."""
    sizes: dict[tuple, list[float]] = {}
    unseen: dict[tuple, Candidate] = {}
    directions = joint.noise.whiten(chance.candidate_directions(joint, fitted, list(candidates)))
    share = found.information / np.maximum((directions**2).sum(axis=0), 1e-300)
    for k, candidate in enumerate(candidates):
        if found.seen[k]:
            size = threshold / np.sqrt(found.information[k]) * candidate.typical[0]
            # where the law follows nearly all of a direction, the linear score says little of what it leaves
            size *= _refit_ratio(joint, fitted, candidate, size, threshold) if share[k] < CLOSE else 1.0
            if size <= candidate.cause.largest(joint.observed):
                sizes.setdefault(candidate.key, []).append(size)
                continue
        hidden = _hidden_bias(joint, fitted, candidate, threshold)
        if hidden is not None:
            sizes[candidate.key] = [hidden]
        unseen.setdefault(candidate.key, candidate)
    limits = {key: float(np.quantile(values, MOST)) for key, values in sizes.items()}
    return limits, [candidate for key, candidate in unseen.items() if key not in limits]


def _hidden_bias(joint: Joint, fitted: Fitted, candidate: Candidate, threshold: float) -> float | None:
    """Limit of an error of temperature that the shift law follows, by how it must bend; None where none shows."""
    first = candidate.cause.parameters[0]
    size = HIDDEN * first.typical
    while isinstance(candidate.place, float) and size <= first.high:
        factor = _limit_ratio(joint, fitted, candidate, size, threshold)
        if np.isfinite(factor):
            return factor * size
        size *= 2.0
    return None


def _refit_ratio(joint: Joint, fitted: Fitted, candidate: Candidate, size: float, threshold: float) -> float:
    """By how much the limit grows when the law may follow the effect as far as it can; infinite if it does."""
    # No law follows what one specimen does: its linear limit holds.
    if isinstance(candidate.place, str):
        return 1.0
    return max(_limit_ratio(joint, fitted, candidate, size, threshold), 1.0)


def _limit_ratio(joint: Joint, fitted: Fitted, candidate: Candidate, size: float, threshold: float) -> float:
    """Detection limit divided by `size`, a size near it, found by refitting; infinite where the law follows the effect.

    The fitted model with the effect stands for the table, without scatter; what the law without the effect leaves
    of it is the strength that is seen.
    """
    present = (*fitted.active, candidate.replace_values(np.array([size, *candidate.values[1:]])))
    modulus = joint.apparent(fitted.law, present, fitted.scales)[0]
    table = Joint(replace(joint.observed, modulus=modulus), joint.base, joint.noise)
    # against the truth, not zero: the priors of law and scales cost something there too
    truth = table.linearise(fitted.law, fitted.scales, present).objective
    refit = table.fit(fitted.law, fitted.scales, fitted.active, CONVERGED)
    _, refitted = fit_roughness(table, refit, CONVERGED)
    left = refitted.objective - truth
    strength = float(np.sqrt(max(left, 0.0)))
    return threshold / strength if strength > AT_LEAST * threshold else np.inf


def _alike(candidates: Sequence[Candidate], correlation: NDArray) -> list[tuple[Candidate, Candidate]]:
    """Pairs that even three times the detection limit does not tell apart, by the correlation (k, k) of their z."""
    out: dict[tuple, tuple[Candidate, Candidate]] = {}
    for i, one in enumerate(candidates):
        for k in range(i):
            other = candidates[k]
            # Of strength z along one direction a correlated one leaves z^2 (1 - r^2).
            left = STRONGEST**2 * (1.0 - correlation[i, k] ** 2)
            if one.cause.name != other.cause.name and left < TWENTY_TIMES:
                out.setdefault((other.key, one.key), (other, one))
    return list(out.values())


def place_limits(state: State, surveyed: Survey) -> list[tuple[Candidate, float]]:
    """Each fault of one place at its detection limit, where one may be so large, and its standard error."""
    if not surveyed.candidates:
        return []
    _, errors = likelihood.correlation(state.model, surveyed.pointing, state.variances)
    limits = []
    for candidate, error in zip(surveyed.candidates, errors, strict=True):
        amplitude = candidate.cause.parameters[0]
        std_error = float(error) * amplitude.typical
        near = candidate.replace_values(np.array([NEARLY_SURE * std_error]))
        # odds without a gain, which half of z squared has to beat
        odds = log_odds(near, state.plain.observed, 0.0, std_error)
        size = TAKEN_UP * (max(NEARLY_SURE, np.sqrt(max(-2.0 * odds, 0.0))) + Z_95) * std_error
        if size <= amplitude.high:
            limits.append((candidate.replace_values(np.array([size])), std_error))
    return limits
