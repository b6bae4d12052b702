"""How much further tests would say of causes, given the tests that were done: Fisher information, law marginalised.

Near the fit, ln E* = H x + D a + scatter. x holds what is not asked for: the law of the mix, the specimens' scales and
the discrepancy, each with its prior; a holds the amplitudes of causes. With x integrated out, tests add up: the
information of the new tests on `a` is that of their innovation, what the old ones do not predict yet
(Lindley 1956; Chaloner & Verdinelli 1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve, solve_triangular

Matrix = NDArray[np.float64]
Complex = NDArray[np.complex128]
Vector = NDArray[np.float64]
LEAST = 1e-9  # information of a prior that says nothing
TOGETHER = 128  # sets of tests that are weighed at once, so that memory stays small


@dataclass(frozen=True)
class Linear:
    """The model of N possible tests, linearised.

    `nuisance` (N, q) is d ln E*/dx; `precision` (q, q) of x before any test; `effects` (N, K) is d ln E*/da, of one
    typical amplitude of each cause.
    """

    nuisance: Complex
    precision: Matrix
    effects: Complex


@dataclass(frozen=True)
class Tested:
    """Tests done together: `rows` (n,) in the model and `scatter` (2n, 2n), the covariance of ln|E*| and phase."""

    rows: NDArray[np.int64]
    scatter: Matrix


def parts(values: Complex) -> Matrix:
    """ln E* (n, ...) as real (2n, ...): ln|E*| first, then phase."""
    return np.concatenate([values.real, values.imag])


def _whitened(lower: NDArray, values: Matrix) -> Matrix:
    """Values (m, ...) in units of a covariance of this lower Cholesky factor (m, m)."""
    return np.asarray(solve_triangular(lower, values, lower=True, check_finite=False))


class Knowledge:
    """What some tests say; information (K, K) is of the amplitudes, with everything else integrated out."""

    def __init__(self, linear: Linear, tested: Sequence[Tested]) -> None:
        gram = linear.precision + LEAST * np.eye(linear.nuisance.shape[1])
        # Of each set of tests: its rows, the root of its scatter, and the nuisance in units of that.
        self._done: list[tuple[NDArray[np.int64], NDArray, Matrix]] = []
        for tests in tested:
            lower = np.linalg.cholesky(tests.scatter)
            h = _whitened(lower, parts(linear.nuisance[tests.rows]))
            gram += h.T @ h
            self._done.append((tests.rows, lower, h))
        self._h, self._lower = parts(linear.nuisance), np.linalg.cholesky(gram)
        self._judge(linear.effects)

    def with_effects(self, effects: Complex) -> Knowledge:
        """The same of other effects (N, K)."""
        new = copy(self)
        new._judge(effects)
        return new

    def _judge(self, effects: Complex) -> None:
        k = effects.shape[1]
        cross, own = np.zeros((self._lower.shape[0], k)), np.zeros((k, k))
        for rows, lower, h in self._done:
            d = _whitened(lower, parts(effects[rows]))
            cross, own = cross + h.T @ d, own + d.T @ d
        followed = self._expected(cross)  # by how much x takes up each effect in these tests
        self.information = own - cross.T @ followed
        # Of each effect, what these tests do not predict.
        self._left = parts(effects) - self._h @ followed

    @cached_property
    def _spread(self) -> Matrix:
        """(2N, q): its product with its transpose is the covariance of ln|E*| and phase that these tests leave."""
        return _whitened(self._lower, self._h.T).T

    def mean(self, left: Complex) -> Vector:
        """Mean (q,) of x where the first set of tests departs by `left` (n,) in ln E* from the model."""
        _, lower, h = self._done[0]
        return self._expected(h.T @ _whitened(lower, parts(left)))

    def _expected(self, weighed: Matrix) -> Matrix:
        """Mean (q, ...) of x; `weighed` (q, ...) is H^T of the inverse scatter times the data."""
        return np.asarray(cho_solve((self._lower, True), weighed, check_finite=False))

    def gained(self, tests: Sequence[Tested]) -> Matrix:
        """Information (M, K, K) of the amplitudes that each of M sets of further tests would add."""
        more = np.zeros((len(tests), *self.information.shape))
        sizes = np.array([one.rows.size for one in tests])
        for size in np.unique(sizes[sizes > 0]):
            alike = np.flatnonzero(sizes == size)
            for some in np.array_split(alike, -(-alike.size // TOGETHER)):
                rows, scatter = np.array([tests[k].rows for k in some]), [tests[k].scatter for k in some]
                lower, left, _ = self._innovation(rows, scatter)
                half = np.linalg.solve(lower, left)
                more[some] = half.transpose(0, 2, 1) @ half
        return more

    def _innovation(
        self, rows: NDArray[np.int64], scatter: Sequence[Matrix]
    ) -> tuple[Matrix, Matrix, Matrix]:
        """Of M sets of n tests, `rows` (M, n), over what was not known: root (M, 2n, 2n) of the covariance of scatter
        and of what the old tests leave open; effects (M, 2n, K); and spread (M, 2n, q), both in plain units.
        """
        at = np.concatenate([rows, rows + self._left.shape[0] // 2], axis=1)
        spread = self._spread[at]
        lower = np.linalg.cholesky(np.array(scatter) + spread @ spread.transpose(0, 2, 1))
        return lower, self._left[at], spread

    def posterior(self, tests: Tested) -> Knowledge:
        """What is known with further tests done."""
        # Updated by the tests taken alone: a factor anew would be of all q unknowns, after each order.
        lower, *plain = (value[0] for value in self._innovation(tests.rows[None], [tests.scatter]))
        effects, spread = (_whitened(lower, value) for value in plain)
        new = copy(self)
        new.information = self.information + effects.T @ effects
        new._left = self._left - self._spread @ (spread.T @ effects)
        # (1 - S^T S)^(1/2), with singular values s < 1 of S.
        _, s, vector = np.linalg.svd(spread, full_matrices=False)
        shrunk = 1.0 - np.sqrt(np.maximum(1.0 - s**2, 0.0))
        new._spread = (self._spread @ vector.T * -shrunk) @ vector
        new._spread += self._spread
        return new


@dataclass(frozen=True)
class Question:
    """Is the effect of one cause there, where other causes are free?

    `cause` and `free` are places in the model; `amplitude` is in typical units; `need` is the square of the amplitude
    over its standard error at which the answer is sure enough. `kept` (N,) are the rows that count, old and new: all,
    or those without the test that the cause hangs on. `weight` is the chance that the question matters.
    """

    cause: int
    amplitude: float
    free: tuple[int, ...]
    need: float
    kept: NDArray[np.bool_]
    weight: float = 1.0

    def strength(self, information: Matrix) -> Matrix:
        """Square of the amplitude over its standard error, per set: expected 2 ln of the Bayes factor (Laplace)."""
        free = [k for k in self.free if k != self.cause]
        own = information[..., self.cause, self.cause]
        if free:
            cross, among = information[..., self.cause, free], information[..., free, :][..., free]
            # To a unit diagonal, so that one small ridge suits amplitudes of any unit; causes alike are singular.
            scale = 1.0 / np.sqrt(np.maximum(np.diagonal(among, axis1=-2, axis2=-1), LEAST))
            among = among * scale[..., :, None] * scale[..., None, :] + LEAST * np.eye(len(free))
            cross = cross * scale
            own = own - (cross * np.linalg.solve(among, cross[..., None])[..., 0]).sum(axis=-1)
        return self.amplitude**2 * np.maximum(own, 0.0)

    def nats(self, information: Matrix) -> Matrix:
        """Expected evidence for the right answer [nats], no more than is needed; `information` (..., K, K)."""
        return self.weight * 0.5 * np.minimum(self.strength(information), self.need)


class Inquiry:
    """Open questions, each with the tests that count for it; the state of knowledge as tests are chosen."""

    def __init__(
        self, linear: Linear, old: Tested, questions: Sequence[Question], known: Knowledge | None = None
    ) -> None:
        """`known` is what all of the `old` tests say, where that was found already."""
        self.questions = questions
        kept = {one.kept.tobytes(): one.kept for one in questions}
        self._known = {
            key: known if known and rows[old.rows].all() else Knowledge(linear, [_counted(old, rows)])
            for key, rows in kept.items()
        }

    def gains(self, tests: Sequence[Tested]) -> Matrix:
        """What each of M sets of tests would add to each of Q questions (M, Q) [nats]."""
        after = {
            key: known.information + known.gained([_counted(one, np.frombuffer(key, bool)) for one in tests])
            for key, known in self._known.items()
        }
        gained = [one.nats(after[one.kept.tobytes()]) - one.nats(self._fisher(one)) for one in self.questions]
        return np.column_stack(gained)

    def strengths(self) -> list[float]:
        """`strength` of each question by now."""
        return [float(one.strength(self._fisher(one))) for one in self.questions]

    def _fisher(self, one: Question) -> Matrix:
        """Information of the tests that count for a question."""
        return self._known[one.kept.tobytes()].information

    def take(self, tests: Tested) -> None:
        """Count these tests as done, for every question that they bear on."""
        for key, known in self._known.items():
            kept = _counted(tests, np.frombuffer(key, bool))
            if kept.rows.size:
                self._known[key] = known.posterior(kept)


def _counted(tests: Tested, kept: NDArray[np.bool_]) -> Tested:
    """The tests whose rows in the model are `kept`."""
    if kept[tests.rows].all():
        return tests
    at = np.flatnonzero(kept[tests.rows])
    both = np.concatenate([at, at + tests.rows.size])
    return Tested(tests.rows[at], tests.scatter[np.ix_(both, both)])
