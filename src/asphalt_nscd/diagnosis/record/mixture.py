"""The law of the mix, averaged over what a table cannot decide: with a possible cause, with its rivals, and without.

What is established holds in every hypothesis. What is only possible is in it by its probability, so that values and
intervals of the mix know of the doubt.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtr, stdtrit

from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.observed.scatter import SCALE_FREEDOM, SPECIMEN_PHASE
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.search.hypotheses import Hypothesis
from asphalt_nscd.diagnosis.written import cause_at

CLOSE = 1e-3  # change of the objective at which the fit of a hypothesis ends
HALVINGS = 60


@dataclass(frozen=True)
class Mixture:
    """The mix by all hypotheses, of the tests that are `kept` (n,) of those that the diagnosis used.

    `freedom`: degrees of freedom of the errors of |E*| and of the phase; `specimens`: half of the 95 % interval that
    the specimens leave the phase of their mean [rad].
    """

    hypotheses: tuple[Hypothesis, ...]
    freedom: tuple[float, float]
    kept: NDArray[np.bool_]
    specimens: float = 0.0

    @property
    def weights(self) -> Vector:
        """Probabilities (h,), of sum one."""
        return np.array([one.probability for one in self.hypotheses])

    def possible(self, one: Hypothesis) -> tuple[Candidate, ...]:
        """Causes of a hypothesis that another lacks."""
        others = [{cause.key for cause in other.causes} for other in self.hypotheses]
        sure = set.intersection(*others)
        return tuple(cause for cause in one.causes if cause.key not in sure)

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
        # The law holds all specimens to one causal curve, and knows less of how far apart they are.
        value, half = self.weights @ values.imag, self.specimens
        low, high = np.minimum(ends[0].imag, value - half), np.maximum(ends[1].imag, value + half)
        return ends[0].real + 1j * low, ends[1].real + 1j * high

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
    explanations = tuple(_of_kept(one, kept) for one in diagnosis.hypotheses)
    freedom, specimens = diagnosis.noise.freedom, np.unique(explanations[0].joint.observed.specimen).size
    # Where one specimen is left of several, the others still say how far they lie apart.
    apart = _apart(explanations[0] if specimens > 1 else diagnosis.hypotheses[0])
    # Taken for known, the scatter of two to four specimens held the mix in 88 to 89 % of drawn tables, not 95.
    return Mixture(explanations, (min(freedom, SCALE_FREEDOM + specimens - 1), freedom), kept, apart)


def _apart(one: Hypothesis) -> float:
    """Half of the 95 % interval of the mean phase [rad] where specimens lie apart unusually far, else zero.

    Faults of one specimen are not taken off: which of them is right nobody knows.
    """
    observed = one.joint.observed
    shown = one.along(observed.omega, observed.temperature)[0] + one.effect(one.joint)
    off, label = observed.logarithm.imag - shown.imag, np.unique(observed.specimen)
    if label.size < 2:
        return 0.0
    levels = np.array([off[observed.specimen == k].mean() for k in label])
    beyond = max(levels.var(ddof=1) - SPECIMEN_PHASE**2, 0.0)
    return float(stdtrit(label.size - 1, 0.975) * np.sqrt(beyond / label.size))


def _of_kept(one: Hypothesis, kept: NDArray[np.bool_]) -> Hypothesis:
    """An explanation fitted anew to the tests (n,) that are `kept`, with the causes that they hold."""
    if kept.all():
        return one
    every = one.joint
    joint = Joint(every.observed.subset(kept), every.base, every.noise.subset(kept))
    active = tuple(
        cause for cause in one.fitted.active if cause.cause.rows(joint.observed, cause.place).any()
    )
    return replace(one, joint=joint, fitted=joint.fit(one.fitted.law, one.fitted.scales, active, CLOSE))


def averaged_over(mix: Mixture) -> str:
    """The hypotheses of a mixture with their probabilities, in a line: `phase offset 78 %, none of these 22 %`."""
    parts = []
    for one in mix.hypotheses:
        causes = " and ".join(cause_at(*cause.key) for cause in mix.possible(one))
        parts.append(f"{causes or 'no possible cause'} {100.0 * one.probability:.0f} %")
    return ", ".join(parts) if len(parts) > 1 else "one hypothesis"


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
