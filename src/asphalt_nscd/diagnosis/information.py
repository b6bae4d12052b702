"""How much further tests would say of causes, given the tests that were done: Fisher information, law marginalised.

Near the fit, ln E* = H x + D a + scatter. x holds what is not asked for: the law of the mix, the specimens' scales and
the discrepancy, each with its prior; a holds the amplitudes of causes. With x integrated out, tests add up: the
information of the new tests on `a` is that of their innovation, what the old ones do not predict yet
(Lindley 1956; Chaloner & Verdinelli 1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

Matrix = NDArray[np.float64]
Complex = NDArray[np.complex128]
LEAST = 1e-9  # information of a prior that says nothing


@dataclass(frozen=True)
class Linear:
    """The model of N possible tests, linearised.

    nuisance (N, q): d ln E*/dx; precision (q, q): of x before any test; effects (N, K): d ln E*/da, of one typical
    amplitude of each cause.
    """

    nuisance: Complex
    precision: Matrix
    effects: Complex


@dataclass(frozen=True)
class Tested:
    """n tests done together: their rows in the model, and the covariance (2n, 2n) of ln|E*| and phase by scatter."""

    rows: NDArray[np.int64]
    scatter: Matrix


def parts(values: Complex) -> Matrix:
    """(n, ...) complex as (2n, ...) real: ln|E*| first, then phase."""
    return np.concatenate([values.real, values.imag])


class Knowledge:
    """What some tests say. information (K, K): of the amplitudes, with everything else integrated out."""

    def __init__(self, linear: Linear, tested: Sequence[Tested]) -> None:
        self.linear, self.tested = linear, tuple(tested)
        q, k = linear.nuisance.shape[1], linear.effects.shape[1]
        gram, cross, own = linear.precision + LEAST * np.eye(q), np.zeros((q, k)), np.zeros((k, k))
        for tests in tested:
            lower = np.linalg.cholesky(tests.scatter)
            h, d = (
                solve_triangular(lower, parts(values[tests.rows]), lower=True, check_finite=False)
                for values in (linear.nuisance, linear.effects)
            )
            gram, cross, own = gram + h.T @ h, cross + h.T @ d, own + d.T @ d
        self.covariance = np.linalg.inv(gram)
        followed = self.covariance @ cross  # by how much x takes up each effect in these tests
        self.information = own - cross.T @ followed
        h = parts(linear.nuisance)
        self._left = parts(linear.effects) - h @ followed  # of each effect, what these tests do not predict
        self.spread = (
            h @ self.covariance @ h.T
        )  # covariance (2N, 2N) of ln|E*| and phase that these tests leave

    def gained(self, tests: Tested) -> Matrix:
        """Information (K, K) that further tests would add."""
        at = self._places(tests.rows)
        lower = np.linalg.cholesky(tests.scatter + self.spread[np.ix_(at, at)])
        half = solve_triangular(lower, self._left[at], lower=True, check_finite=False)
        return half.T @ half

    def _places(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.concatenate([rows, rows + self.linear.nuisance.shape[0]])

    def after(self, tests: Tested) -> Knowledge:
        """With further tests done."""
        return Knowledge(self.linear, (*self.tested, tests))


@dataclass(frozen=True)
class Question:
    """Is the effect of one cause there, of an amplitude [typical units], where other causes are free?

    need: square of the amplitude over its standard error at which the answer is sure enough; weight: chance that the
    question matters.
    """

    cause: int
    amplitude: float
    free: tuple[int, ...]
    need: float
    weight: float = 1.0

    def strength(self, information: Matrix) -> Matrix:
        """Square of the amplitude over its standard error: expected 2 ln of the Bayes factor (Laplace).

        information (..., K, K): of one set of tests or of many.
        """
        free = [k for k in self.free if k != self.cause]
        own = information[..., self.cause, self.cause]
        if free:
            cross, among = information[..., self.cause, free], information[..., free, :][..., free]
            scale = 1.0 / np.sqrt(np.maximum(np.diagonal(among, axis1=-2, axis2=-1), LEAST))
            among = among * scale[..., :, None] * scale[..., None, :] + LEAST * np.eye(len(free))
            cross = cross * scale
            own = own - (cross * np.linalg.solve(among, cross[..., None])[..., 0]).sum(axis=-1)
        return self.amplitude**2 * np.maximum(own, 0.0)

    def nats(self, information: Matrix) -> Matrix:
        """Expected evidence for the right answer, no more than is needed."""
        return self.weight * 0.5 * np.minimum(self.strength(information), self.need)


@dataclass(frozen=True)
class Asked:
    """A question and what is known to it: all tests, or those without the one that the cause hangs on.

    kept (N,): rows of the model that count for it, old and new.
    """

    question: Question
    kept: NDArray[np.bool_]


class Inquiry:
    """Open questions, each with the tests that count for it; the state of knowledge as tests are chosen."""

    def __init__(self, linear: Linear, old: Tested, asked: Sequence[Asked]) -> None:
        self.asked = list(asked)
        self._linear = linear
        self._known: dict[bytes, Knowledge] = {}
        for one in self.asked:
            if one.kept.tobytes() not in self._known:
                kept = _some(old, one.kept)
                self._known[one.kept.tobytes()] = Knowledge(linear, [] if kept is None else [kept])

    def known(self, one: Asked) -> Knowledge:
        return self._known[one.kept.tobytes()]

    def gains(self, tests: Sequence[Tested]) -> Matrix:
        """Nats (M, Q) that each of M sets of tests would add to each question."""
        after = {}
        for key, known in self._known.items():
            kept = (_some(one, np.frombuffer(key, bool)) for one in tests)
            nothing = np.zeros_like(known.information)
            more = [nothing if one is None else known.gained(one) for one in kept]
            after[key] = known.information + np.array(more)
        return np.column_stack([
            one.question.nats(after[one.kept.tobytes()]) - one.question.nats(self.known(one).information)
            for one in self.asked
        ])  # fmt: skip

    def strengths(self) -> list[float]:
        return [float(one.question.strength(self.known(one).information)) for one in self.asked]

    def take(self, tests: Tested) -> None:
        """Do the tests."""
        for key, known in self._known.items():
            kept = _some(tests, np.frombuffer(key, bool))
            if kept is not None:
                self._known[key] = known.after(kept)


def _some(tests: Tested, kept: NDArray[np.bool_]) -> Tested | None:
    """Those of the tests that count; None if none does."""
    at = np.flatnonzero(kept[tests.rows])
    if not at.size:
        return None
    both = np.concatenate([at, at + tests.rows.size])
    return Tested(tests.rows[at], tests.scatter[np.ix_(both, both)])
