"""The law of the mix, averaged over what a table cannot decide: with a possible cause, with its rivals, and without.

What is established holds in every hypothesis. What is only possible is in it by its probability, so that values and
intervals of the mix know of the doubt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtr

from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.observed.scatter import SCALE_FREEDOM
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.search.ladder import Rung
from asphalt_nscd.files.words import specimen_named

LEAST = 0.01  # probability of a set of causes that counts
CLOSE = 1e-3  # change of the objective at which the fit of a hypothesis ends
HALVINGS = 60
Choice = tuple[float, Candidate | None]


@dataclass(frozen=True)
class Hypothesis:
    """A set of causes, how probable it is, and the law of the mix fitted with them to the tests that are kept."""

    probability: float
    joint: Joint
    fitted: Fitted
    possible: tuple[Candidate, ...] = ()  # those that other hypotheses lack

    def effect(self, every: Joint) -> Complex:
        """ln (n,) of what the causes do to E* in each test."""
        law = self.fitted.law
        return _logarithm(every.apparent(law, self.fitted.active)[0] / every.apparent(law, ())[0])

    def along(self, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """ln E* (n,) of the mix and its derivative (n, p) by the parameters of the free curve."""
        modulus, slope = self.joint.base.modulus(self.fitted.law, omega, temperature)
        return _logarithm(modulus), slope / modulus[:, None]

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Of the parameters (p, p) of the free curve."""
        size = self.fitted.law.size
        return self.fitted.covariance[:size, :size]


@dataclass(frozen=True)
class Mixture:
    """The mix by all hypotheses, of the tests that are `kept` (n,) of those that the diagnosis used.

    `freedom`: degrees of freedom of the errors of |E*| and of the phase.
    """

    hypotheses: tuple[Hypothesis, ...]
    freedom: tuple[float, float]
    kept: NDArray[np.bool_]

    @property
    def weights(self) -> Vector:
        """Probabilities (h,), of sum one."""
        return np.array([one.probability for one in self.hypotheses])

    @property
    def base(self) -> FlexibleSpectrum:
        """The free curve of the likeliest."""
        return self.hypotheses[0].joint.spectrum

    @property
    def law(self) -> Vector:
        """Its parameters (p,) by the likeliest."""
        return self.hypotheses[0].fitted.law

    @property
    def tests(self) -> Observations:
        """The tests that are kept."""
        return self.hypotheses[0].joint.observed

    def effect(self, observed: Observations) -> Complex:
        """ln (n,) of what causes do to E* in each test, in the mean."""
        first = self.hypotheses[0].joint
        every = Joint(observed, first.base, first.noise)
        return self.weights @ np.array([one.effect(every) for one in self.hypotheses])

    def parts(self, omega: Vector, temperature: Vector) -> tuple[Complex, Complex]:
        """ln E* (h, n) of the mix by each hypothesis and standard errors (h, n), of ln|E*| and of the phase [rad]."""
        values, errors = [], []
        for one in self.hypotheses:
            value, slope = one.along(omega, temperature)
            values.append(value)
            errors.append(
                standard_errors(slope.real, one.covariance) + 1j * standard_errors(slope.imag, one.covariance)
            )
        return np.array(values), np.array(errors)

    def interval_95(self, values: Complex, errors: Complex) -> tuple[Complex, Complex]:
        """Ends (n,) of the 95 % interval of the mixture of Student's distributions that `parts` gives."""
        ends = []
        for share in (0.025, 0.975):
            parts = [
                _quantile(share, self.weights, means, sizes, freedom)
                for means, sizes, freedom in (
                    (values.real, errors.real, self.freedom[0]),
                    (values.imag, errors.imag, self.freedom[1]),
                )
            ]
            ends.append(parts[0] + 1j * parts[1])
        return ends[0], ends[1]

    def covariance(self, omega: Vector, temperature: Vector) -> NDArray[np.float64]:
        """Of ln|E*| at these conditions, then of the phase (2n, 2n), within hypotheses and between them."""
        values = self.parts(omega, temperature)[0]
        apart = values - self.weights @ values
        total = np.zeros((2 * omega.size, 2 * omega.size))
        for one, off in zip(self.hypotheses, apart, strict=True):
            along = one.along(omega, temperature)[1]
            slope, away = np.concatenate([along.real, along.imag]), np.concatenate([off.real, off.imag])
            total += one.probability * (slope @ one.covariance @ slope.T + np.outer(away, away))
        return total


def mixture(diagnosis: Diagnosis, kept: NDArray[np.bool_]) -> Mixture:
    """What the diagnosis leaves open of the mix, by the tests (n,) of it that are `kept`."""
    every, fitted = _common(diagnosis)
    observed, noise = every.observed, every.noise
    joint = every if kept.all() else Joint(observed.subset(kept), every.base, noise.subset(kept))
    open_to_doubt = [rung for rung in diagnosis.ladder.rungs if not diagnosis.established(rung)]
    sure = tuple(
        one for one in fitted.active if one.key not in {rung.candidate.key for rung in open_to_doubt}
    )
    found: list[Hypothesis] = []
    sets = sorted(_sets(diagnosis, open_to_doubt, fitted), key=lambda one: -one[0])
    for probability, causes in sets:
        if probability < LEAST and found:
            break
        active = tuple(one for one in (*sure, *causes) if one.cause.rows(joint.observed, one.place).any())
        as_it_was = kept.all() and {one.key for one in active} == {one.key for one in fitted.active}
        again = fitted if as_it_was else joint.fit(fitted.law, fitted.scales, active, CLOSE)
        found.append(Hypothesis(probability, joint, again, causes))
    total = sum(one.probability for one in found)
    weighed = tuple(Hypothesis(h.probability / total, h.joint, h.fitted, h.possible) for h in found)
    freedom, specimens = diagnosis.noise.freedom, np.unique(joint.observed.specimen).size
    # Taken for known, the scatter of two to four specimens held the mix in 88 to 89 % of drawn tables, not 95.
    return Mixture(weighed, (min(freedom, SCALE_FREEDOM + specimens - 1), freedom), kept)


def shares(diagnosis: Diagnosis, rung: Rung) -> tuple[Choice, ...]:
    """A named cause, its rivals and none, each with its probability; an established cause alone."""
    if diagnosis.established(rung):
        return ((1.0, rung.candidate),)
    probability = diagnosis.probability(rung)
    rest = (1.0 - probability) / (1 + len(rung.rivals))
    return (probability, rung.candidate), *((rest, rival) for rival in rung.rivals), (rest, None)


def _sets(
    diagnosis: Diagnosis, rungs: Sequence[Rung], fitted: Fitted
) -> list[tuple[float, tuple[Candidate, ...]]]:
    """Sets of possible causes and their probabilities; named ones as the last fit has them."""
    values = {one.key: one for one in fitted.active}
    found = []
    for chosen in product(*(shares(diagnosis, rung) for rung in rungs)):
        causes = {one.key: values.get(one.key, one) for _, one in chosen if one is not None}
        found.append((float(np.prod([share for share, _ in chosen])), tuple(causes.values())))
    return found


def averaged_over(mix: Mixture) -> str:
    """The hypotheses of a mixture with their probabilities, in a line: `phase offset 78 %, none of these 22 %`."""
    parts = []
    for one in mix.hypotheses:
        causes = " and ".join(map(_words, one.possible))
        parts.append(f"{causes or 'no possible cause'} {100.0 * one.probability:.0f} %")
    return ", ".join(parts) if len(parts) > 1 else "one hypothesis"


def _words(candidate: Candidate) -> str:
    words, place = candidate.cause.name.replace("_", " "), candidate.place
    if place is None:
        return words
    return f"{words} of {specimen_named(place)}" if isinstance(place, str) else f"{words} at {place:g} degC"


def _common(diagnosis: Diagnosis) -> tuple[Joint, Fitted]:
    return diagnosis.common or (diagnosis.ladder.joint, diagnosis.ladder.fitted)


def _logarithm(modulus: Complex) -> Complex:
    return np.log(np.abs(modulus)) + 1j * np.angle(modulus)


def standard_errors(slope: NDArray[np.float64], covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard errors (n,) of quantities with a `slope` (n, p) along p parameters of a `covariance` (p, p)."""
    values, vectors = np.linalg.eigh(covariance)
    # Where a parameter is all but free, rounding makes the least eigenvalues negative, and would a variance.
    return np.linalg.norm(slope @ (vectors * np.sqrt(np.maximum(values, 0.0))), axis=1)


def _quantile(share: float, weights: Vector, means: NDArray, errors: NDArray, freedom: float) -> Vector:
    """Quantile (n,) of a mixture of Student's distributions about `means` (h, n), by bisection."""
    errors = np.maximum(errors, 1e-12)
    freedom = min(freedom, 1e9)
    low, high = (means - 30.0 * errors).min(axis=0), (means + 30.0 * errors).max(axis=0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = weights @ stdtr(freedom, (middle - means) / errors) < share
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)
