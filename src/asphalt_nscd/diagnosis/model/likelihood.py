"""How large a discrepancy is, by restricted likelihood, and what a cause is beside it.

With V0 the covariance of scatter and law (its prior included), U the factors of the processes and v their
variances, V = V0 + U diag(v) U^T. Everything is reduced to the columns of U once (Woodbury), so that the
estimate for one more cause costs milliseconds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dtrtrs

from asphalt_nscd.diagnosis.model.arrowhead import Arrowhead, Factor
from asphalt_nscd.diagnosis.model.discrepancy import LEAST, MOST, Processes
from asphalt_nscd.diagnosis.model.joint import Fitted

Vector = NDArray[np.float64]

UNKNOWN = 2.0  # standard deviation of the ln v that a table tells nothing of
ITERATIONS = 25
NODES = 7  # of Gauss and Hermite's rule, over the logarithm of a size
# Far below the gain of 6 that a name asks for.
CONVERGED = 0.05  # change of -2 ln likelihood
MOST_KEPT = 8  # factors of a model, of megabytes each


@dataclass(frozen=True)
class Reduced:
    """Scatter and law taken out, with A = V0^-1 and data y: `gram` is U^T A U (q, q), `along` (q,) is U^T A y.

    `factors` are those at variances where many estimates begin, whatever the data and the cause.
    """

    processes: Processes
    gram: Arrowhead
    along: Vector
    factors: dict[bytes, Factor] = field(default_factory=dict)

    def factor(self, variances: Vector) -> Factor:
        """The factor at variances (m,)."""
        return Factor(self.gram, np.sqrt(variances)[self.processes.block])

    def kept_factor(self, variances: Vector) -> Factor:
        """The same where other estimates may ask for it too."""
        key = variances.tobytes()
        factor = self.factors.get(key) or self.factor(variances)
        if len(self.factors) < MOST_KEPT:
            self.factors[key] = factor
        return factor

    def selected(self, kept: NDArray[np.bool_]) -> Reduced:
        """The same with some of the processes (m,) alone."""
        found, columns = self.processes.selected(kept), kept[self.processes.block]
        followed = self.gram.followed[:, columns]
        return Reduced(found, Arrowhead(found.gram, followed, found.isotherm), self.along[columns])


@dataclass(frozen=True)
class Direction:
    """Directions d (2n, k) in the same form: `cross` (q, k) U^T A d, `own` (k, k) d^T A d, `along` (k,) d^T A y."""

    cross: NDArray
    own: NDArray
    along: Vector

    def column(self, *kept: int) -> Direction:
        """One of the directions alone, or some."""
        at = list(kept)
        return Direction(self.cross[:, at], self.own[np.ix_(at, at)], self.along[at])


@dataclass(frozen=True)
class Estimate:
    """Variances (m,) of the processes, and the amplitude of the cause that was in the model.

    `misfit` is -2 ln of the penalised likelihood, the cause at its best; `amplitude`, in units of its direction, is
    zero and `std_error` infinite without a cause.
    """

    variances: Vector
    misfit: float
    amplitude: float = 0.0
    std_error: float = np.inf

    @property
    def z(self) -> float:
        """Amplitude in standard errors."""
        return self.amplitude / self.std_error


def reduce(found: Processes, fitted: Fitted) -> Reduced:
    """The model linearised at a fit, whitened by the scatter alone and reduced to all that an estimate needs."""
    followed, _ = dtrtrs(np.linalg.cholesky(fitted.precision), fitted.jacobian.T @ found.factor, lower=1)
    return Reduced(found, Arrowhead(found.gram, followed, found.isotherm), _data(fitted, found.factor))


def directions(model: Reduced, fitted: Fitted, d: NDArray) -> Direction:
    """Directions (2n, k) of causes, whitened and reduced as the model is."""
    factor = model.processes.factor
    return Direction(
        factor.T @ d - _followed(fitted, factor, d), d.T @ d - _followed(fitted, d, d), _data(fitted, d)
    )


def moved(model: Reduced, cause: Direction, amount: float) -> tuple[Reduced, Direction]:
    """The same with so much of an effect, in units of its direction, added to the data."""
    return (
        replace(model, along=model.along + amount * cause.cross[:, 0]),
        replace(cause, along=cause.along + amount * cause.own[:, 0]),
    )


def _followed(fitted: Fitted, left: NDArray, right: NDArray) -> NDArray:
    """left^T (1 - A) right: what the law may follow."""
    j = fitted.jacobian
    # A itself would be 2n x 2n: only its products with few columns are formed.
    return (left.T @ j) @ np.linalg.solve(fitted.precision, j.T @ right)


def _data(fitted: Fitted, left: NDArray) -> Vector:
    """left^T A y, also where the fit is not the best one by this measure."""
    to_best = np.linalg.solve(fitted.precision, fitted.gradient)
    return left.T @ (fitted.residual - fitted.jacobian @ to_best)


def estimate(model: Reduced, cause: Direction | None = None, start: Vector | None = None) -> Estimate:
    """Maximise the penalised restricted likelihood by multiplicative steps (Zhou et al. 2019), extrapolated (SQUAREM).

    `start` (m,) are variances, the usual ones if None; `cause` is one direction that is in the model, or none.
    """
    lowest, highest = np.log(LEAST), np.log(MOST)
    usual = model.processes.usual
    # On ln v variances stay above zero, and steps by orders of magnitude are short.
    log_v = np.log(usual**2 if start is None else np.maximum(start, LEAST))
    log_v[model.processes.known] = np.log(usual[model.processes.known] ** 2)
    now = _point(model, cause, log_v, model.kept_factor(np.exp(log_v)))
    # SQUAREM: two multiplicative steps, then a long one along both, taken back where it does not gain
    for _ in range(ITERATIONS):
        first = np.clip(log_v + now.step, lowest, highest)
        middle = _point(model, cause, first)
        second = np.clip(first + middle.step, lowest, highest)
        one, change = first - log_v, second - 2.0 * first + log_v
        # The third step length of Varadhan & Roland (2008); at 1 the long step is the two short ones.
        reach = float(np.clip(np.linalg.norm(one) / np.maximum(np.linalg.norm(change), 1e-12), 1.0, 20.0))
        far = np.clip(log_v + 2.0 * reach * one + reach**2 * change, lowest, highest)
        trial = _point(model, cause, far)
        # Written so that a NaN too is taken back.
        if not trial.objective <= middle.objective:
            far, trial = second, _point(model, cause, second)
        # A narrow prior may make a step overshoot.
        if not trial.objective <= now.objective:
            break
        gained, log_v, now = now.objective - trial.objective, far, trial
        if gained < CONVERGED:
            break
    return Estimate(np.exp(log_v), now.misfit, now.amplitude, now.std_error)


def typical_variance(
    model: Reduced, free: Sequence[Direction], k: int, size: tuple[float, float], variances: Vector
) -> float:
    """Posterior mean, of its logarithm, of one variance where any of some directions is free; others are given.

    `size` is the usual size and the spread of its logarithm. A mean and no mode: few isotherms leave its size unknown;
    of the logarithm, for the few laboratories that may be far worse would outweigh all others.
    """
    nodes, weights = np.polynomial.hermite_e.hermegauss(NODES)
    tried = (size[0] * np.exp(size[1] * nodes)) ** 2
    log_weight = np.tile(np.log(weights), (len(free), 1))
    for column, variance in enumerate(tried):
        v = np.maximum(np.where(np.arange(variances.size) == k, variance, variances), LEAST)
        factor, prior = model.factor(v), model.processes.prior(v)[0]
        for row, one in enumerate(free):
            log_weight[row, column] -= 0.5 * (_point(model, one, np.log(v), factor).objective - prior)
    share = np.exp(log_weight - log_weight.max())
    return float(np.exp((share @ np.log(tried)).sum() / share.sum()))


def widen_error(model: Reduced, cause: Direction, found: Estimate) -> Estimate:
    """The same with a standard error that holds what is not known of the variances (Kackar and Harville 1984).

    Their covariance is that of the curvature of the objective; what the table does not tell is held to a factor.
    """
    curvature, along = _curvature(model, cause, found.variances)
    value, vector = np.linalg.eigh(0.5 * curvature)  # half of it, for -2 ln likelihood
    # Where the table says nothing of a size, its factor of e^2 keeps the error finite.
    spread = (vector.T @ along) ** 2 / (np.maximum(value, 0.0) + UNKNOWN**-2)
    return replace(found, std_error=float(np.sqrt(found.std_error**2 + spread.sum())))


def _curvature(model: Reduced, cause: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """Second derivatives (m, m) of the objective along ln v, and first ones (m,) of the amplitude.

    With P the inverse covariance, law and cause taken out, dP/dv_k = -P U_k U_k^T P.
    """
    found, m = model.processes, variances.size
    factor = model.kept_factor(variances)
    if factor.failed:
        return np.zeros((m, m)), np.zeros(m)
    block, s, left = found.block, factor.s, factor.left
    right = s[:, None] * np.column_stack([model.along, cause.cross[:, 0]])
    solved = factor.solve(right)
    pull, sensed = (solved / s[:, None]).T
    # A direction that law and processes take up whole has no information; rounding would make it negative.
    information = max(float(cause.own[0, 0] - right[:, 1] @ solved[:, 1]), 1e-12)
    pull = pull - sensed * float(cause.along[0] - right[:, 1] @ solved[:, 0]) / information
    left = left - np.outer(sensed, sensed) / information
    member = np.eye(m)[block]
    _, slope, bend = found.prior(variances)
    gradient = np.bincount(block, np.diag(left) - pull**2, m) + slope
    second = member.T @ (2.0 * pull[:, None] * left * pull - left**2) @ member
    second[range(m), range(m)] += gradient / variances + bend
    along = np.where(found.known, 0.0, -variances * np.bincount(block, sensed * pull, m) / information)
    return variances[:, None] * second * variances, along


@dataclass(frozen=True)
class _Point:
    """objective: of the restricted likelihood; misfit: the same without the size of the cause's interval.

    `pull` (q,) is U^T P y and `sensed` (q,) U^T P d, where the cause is in the model, of `information`.
    """

    objective: float
    misfit: float
    processes: Processes
    variances: Vector
    factor: Factor
    pull: Vector
    sensed: Vector
    amplitude: float = 0.0
    information: float = 0.0

    @property
    def std_error(self) -> float:
        """Of the amplitude; infinite without a cause."""
        return self.information**-0.5 if self.information else np.inf

    @cached_property
    def step(self) -> Vector:
        """Multiplicative step (m,) of ln v, made where it is asked for: it costs as much as the rest."""
        found, block, m = self.processes, self.processes.block, self.variances.size
        if self.factor.failed:
            return np.zeros(m)
        diagonal = self.factor.diagonal
        if self.information:
            diagonal = diagonal - self.sensed**2 / self.information
        _, slope, _ = found.prior(self.variances)
        # A prior that falls counts with the data, one that rises with the trace, so that both stay positive.
        trace = np.bincount(block, np.maximum(diagonal, 0.0), m) + np.maximum(slope, 0.0)
        square = np.bincount(block, self.pull**2, m) + np.maximum(-slope, 0.0)
        # It keeps variances positive; its power of a half makes it monotone (minorise-maximise).
        return np.where(found.known, 0.0, 0.5 * np.log(np.maximum(square, 1e-12) / trace))


def _point(model: Reduced, cause: Direction | None, log_v: Vector, factor: Factor | None = None) -> _Point:
    """S^-1 B^-1 S y is what is left of the data; `factor` is the one there, where it is known."""
    found, v = model.processes, np.exp(log_v)
    factor = factor or model.factor(v)
    s = factor.s
    if factor.failed:
        return _Point(np.inf, np.inf, found, v, factor, s, s)
    data = s * model.along
    right = data[:, None] if cause is None else np.column_stack([data, s * cause.cross[:, 0]])
    solved = factor.solve(right)
    pull, sensed = solved[:, 0] / s, solved[:, -1] / s
    misfit = factor.log_determinant - float(data @ solved[:, 0]) + found.prior(v)[0]
    if cause is None:
        return _Point(misfit, misfit, found, v, factor, pull, sensed)
    information = max(float(cause.own[0, 0] - right[:, 1] @ solved[:, 1]), 1e-12)
    along = float(cause.along[0] - right[:, 1] @ solved[:, 0])
    amplitude = along / information
    misfit -= along * amplitude
    # ln information is what restricted likelihood pays for the amplitude, as for the law
    objective = misfit + float(np.log(information))
    return _Point(
        objective, misfit, found, v, factor, pull - sensed * amplitude, sensed, amplitude, information
    )


def correlation(model: Reduced, all_directions: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """How k directions hang together where nothing is hidden: correlation (k, k) of their z, standard errors (k,)."""
    information, _ = weighed(model, all_directions, variances)
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    return information / size[:, None] / size, 1.0 / size


def weighed(model: Reduced, all_directions: Direction, variances: Vector) -> tuple[NDArray, Vector]:
    """Information (k, k) and score (k,) of the amplitudes of k directions, law and discrepancy integrated out."""
    factor = model.kept_factor(variances)
    half = factor.halve(factor.s[:, None] * all_directions.cross)
    data = factor.halve((factor.s * model.along)[:, None])[:, 0]
    return all_directions.own - half.T @ half, all_directions.along - half.T @ data
