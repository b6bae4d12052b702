"""What a table could have shown: the detection limit of each cause, and causes that look alike in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from asphalt_nscd.diagnosis.criteria import USUAL_THRESHOLD, Z_95
from asphalt_nscd.diagnosis.model import chance
from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.chance import Scores
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.model.start import fit_roughness

CLOSE = 0.05  # share of a direction left by the law, below which the law is refitted to see what it follows
AT_LEAST = 0.5  # share of the strength that must survive the refit
MOST = 0.9  # of the shapes of a cause
HIDDEN = 5.0  # typical sizes, where the search begins for an error of temperature that the shift follows
CONVERGED = 0.01  # change of the objective at which such a refit ends
STRONGEST = 3.0 * (USUAL_THRESHOLD + Z_95)  # three times a usual limit


def detection_limits(
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
    hidden = isinstance(candidate.place, float) and isinstance(joint.base, FlexibleSpectrum)
    while hidden and size <= first.high:
        factor = _limit_ratio(joint, fitted, candidate, size, threshold)
        if np.isfinite(factor):
            return factor * size
        size *= 2.0
    return None


def _refit_ratio(joint: Joint, fitted: Fitted, candidate: Candidate, size: float, threshold: float) -> float:
    """By how much the limit grows when the law may follow the effect as far as it can; infinite if it does."""
    # No law follows what one specimen does: its linear limit holds.
    if isinstance(candidate.place, str) or not isinstance(joint.base, FlexibleSpectrum):
        return 1.0
    return max(_limit_ratio(joint, fitted, candidate, size, threshold), 1.0)


def _limit_ratio(joint: Joint, fitted: Fitted, candidate: Candidate, size: float, threshold: float) -> float:
    """The limit over a size near it; infinite where the law follows an effect of this size.

    The fitted model with the effect stands for the table, without scatter; what the law without the effect leaves
    of it is the strength that is seen.
    """
    present = (*fitted.active, candidate.replace_values(np.array([size, *candidate.values[1:]])))
    modulus = joint.apparent(fitted.law, present, fitted.scales)[0]
    shown = Joint(replace(joint.observed, modulus=modulus), joint.base, joint.noise)
    # against the truth, not zero: the priors of law and scales cost something there too
    truth = shown.linearise(fitted.law, fitted.scales, present).objective
    follows = shown.fit(fitted.law, fitted.scales, fitted.active, CONVERGED)
    left = fit_roughness(shown, follows, CONVERGED)[1].objective - truth
    strength = float(np.sqrt(max(left, 0.0)))
    return threshold / strength if strength > AT_LEAST * threshold else np.inf


def alike(
    candidates: Sequence[Candidate], found: Scores, as_good: float
) -> list[tuple[Candidate, Candidate]]:
    """Pairs that even three times the detection limit does not tell apart; `as_good`: gain they may differ by."""
    correlation = found.correlation
    out: dict[tuple, tuple[Candidate, Candidate]] = {}
    for i, one in enumerate(candidates):
        for k in range(i):
            other = candidates[k]
            if one.cause.name == other.cause.name or not (found.seen[i] and found.seen[k]):
                continue
            # Of strength z along one direction a correlated one leaves z^2 (1 - r^2).
            if STRONGEST**2 * (1.0 - correlation[i, k] ** 2) < as_good:
                out.setdefault((other.key, one.key), (other, one))
    return list(out.values())
