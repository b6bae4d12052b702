"""How large each cause may be beside a discrepancy: what was found, and from where on it would be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import logit

from asphalt_nscd.diagnosis.criteria import (
    ALPHA_PER_STEP,
    HIDES,
    POSSIBLE,
    TWENTY_TIMES,
    USUAL_THRESHOLD,
    Z_95,
)
from asphalt_nscd.diagnosis.model import likelihood
from asphalt_nscd.diagnosis.model.chance import Scores
from asphalt_nscd.diagnosis.model.fit_beside import (
    State,
    answers,
    settle,
    shape_cost,
    smoothed,
    taken_amplitude,
)
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.model.probability import log_odds
from asphalt_nscd.diagnosis.search import limits, with_discrepancy
from asphalt_nscd.diagnosis.search.with_discrepancy import Survey, largest_by_chance

Vector = NDArray[np.float64]
LARGER = 1.25  # by which a limit is raised where a discrepancy or the law would take the effect up
TIMES = 6  # that it is raised at most beside a discrepancy


def estimates(state: State, surveyed: Survey) -> dict[tuple, tuple[float, float]]:
    """Amplitude and standard error, in physical units, of every cause at every place.

    Of a cause that is in the fit, and of each other as if it were the next one. Of several shapes, the one that the
    table sees best.
    """
    out: dict[tuple, tuple[float, float]] = {}
    for active in state.fitted.active:
        own = taken_amplitude(state, active, sizes_too=True)
        out[active.key] = (own.amplitude * active.typical[0], own.std_error * active.typical[0])
    best: dict[tuple, int] = {}
    for k, candidate in enumerate(surveyed.candidates):
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
    amplitude = (threshold + Z_95) * one.std_error
    for _ in range(TIMES):
        seen = amplitude - Z_95 * one.std_error
        model, pointing = likelihood.moved(state.model, direction, seen - one.amplitude)
        beside = likelihood.estimate(model, pointing, one.variances).misfit
        # A name asks for both: a gain over the discrepancy, and odds over none that hold what is usual of the cause.
        present = candidate.replace_values(np.array([amplitude * typical, *candidate.values[1:]]))
        # The first answer without the cause that does as well settles it; the slowest start comes last.
        gains = (without.misfit - beside for without in answers(model, state.variances))
        if all(
            gain > TWENTY_TIMES
            and log_odds(present, state.plain.observed, gain, one.std_error * typical) > logit(POSSIBLE)
            for gain in gains
        ):
            break
        amplitude *= LARGER
    return amplitude


def _carried_from(state: State, candidate: Candidate, std_error: float, threshold: float) -> float:
    """Amplitude [typical units] from which a cause with shapes gets its name; above its largest where it never does.

    It is put into these tests, less what chance may take off it, and judged as the search would judge it.
    """
    at, active, typical = state.fitted, state.fitted.active, float(candidate.typical[0])
    stands = state.wide.apparent(at.law, active, at.scales)[0]
    amplitude = (threshold + Z_95) * std_error
    while amplitude * typical <= candidate.cause.largest(state.plain.observed):
        size = (amplitude - Z_95 * std_error) * typical
        present = candidate.replace_values(np.array([size, *candidate.values[1:]]))
        moved = state.wide.apparent(at.law, (*active, present), at.scales)[0] / stands
        observed = replace(state.plain.observed, modulus=state.plain.observed.modulus * moved)
        plain = Joint(observed, state.plain.base, state.plain.noise)
        # A rougher law follows more of it.
        before = smoothed(settle(plain, state.model.processes, at, active, state.variances))
        after = settle(plain, state.model.processes, at, (*active, present), state.variances)
        taken = after.fitted.active[-1]
        gain = before.misfit - after.misfit - shape_cost(after.fitted, taken, observed)
        own = taken_amplitude(after, taken)
        odds = log_odds(taken, observed, gain, own.std_error * typical)
        if (
            gain > TWENTY_TIMES
            and odds > logit(POSSIBLE)
            and with_discrepancy.stands(before, after, taken, own)
        ):
            break
        amplitude *= LARGER
    return amplitude


def detection_limits(
    state: State, surveyed: Survey, draws: int, random: np.random.Generator
) -> tuple[dict[tuple, float], list[Candidate], list[tuple[Candidate, Candidate]]]:
    """Limits beside this table's discrepancy by cause and place, causes never seen in it, and pairs that look alike."""
    sizes: dict[tuple, float] = {}
    unseen: list[Candidate] = []
    alike: list[tuple[Candidate, Candidate]] = []
    taken_up: set[tuple] = set()
    threshold = USUAL_THRESHOLD
    if surveyed.candidates:
        threshold = float(
            np.quantile(largest_by_chance(state, surveyed, draws, random), 1.0 - ALPHA_PER_STEP)
        )
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
            if alone and surveyed.candidates[k].shaped:
                needed = _carried_from(state, surveyed.candidates[k], float(errors[k]), threshold)
            else:
                needed = _named_from(state, surveyed, k, threshold)
            needed /= threshold + Z_95
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
        sizes, unseen = limits.detection_limits(
            state.wide, state.fitted, surveyed.candidates, found, threshold + Z_95
        )
        hidden = {one.key: one for one in surveyed.candidates if one.key in taken_up & sizes.keys()}
        unseen += hidden.values()
        sizes = {key: size for key, size in sizes.items() if key not in hidden}
        every = replace(found, seen=np.ones(errors.size, bool))
        alike = limits.alike(surveyed.candidates, every, TWENTY_TIMES)
    for active in state.fitted.active:
        own = taken_amplitude(state, active)
        sizes[active.key] = (threshold + Z_95) * own.std_error * float(active.typical[0])
    return sizes, unseen, alike
