"""Block arrowhead matrices: isotherms that hang together by few columns are eliminated one by one.

Most processes of a table reach one isotherm alone, mountings and their temperatures among them; specimens, what all
tests have in common and the law reach several. Of n isotherms with k columns each and r others a factor costs
n k^3 + n k r^2 + r^3, where a dense one costs (n k + r)^3: a fourth, for a thousand tests.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dsyrk, dtrmm, dtrsm
from scipy.linalg.lapack import dpotrf, dtrtri, dtrtrs

Vector = NDArray[np.float64]


class Arrowhead:
    """A Gram matrix G (q, q) less H^T H, of H (p, q); `group` (q,) numbers what is eliminated alone, -1 what is last.

    Columns of different groups are orthogonal in G. H, what the law follows, joins all of them: its p rows become
    unknowns of their own, which are eliminated last.
    """

    def __init__(self, gram: NDArray, followed: NDArray, group: NDArray[np.int64]) -> None:
        self.followed = followed
        self.order = np.argsort(np.where(group < 0, group.size, group), kind="stable")
        count = np.bincount(group[group >= 0])
        ends = np.cumsum(count)
        self.blocks = [slice(end - size, end) for end, size in zip(ends, count, strict=True) if size]
        self.inner = int(count.sum())
        inner, last = self.order[: self.inner], self.order[self.inner :]
        self.own = [gram[np.ix_(inner[at], inner[at])] for at in self.blocks]
        self.cross = np.asfortranarray(np.vstack([gram[np.ix_(last, inner)], followed[:, inner]]))
        law = followed[:, last]
        self.last = np.block([[gram[np.ix_(last, last)], law.T], [law, np.zeros((law.shape[0],) * 2)]])

    @property
    def followers(self) -> int:
        """Number p of unknowns of the law."""
        return self.followed.shape[0]


class Factor:
    """Lower Cholesky factor of B = 1 + S A S, A = G - H^T H, S roots of variances (q,); left is S^-1 (1 - B^-1) S^-1.

    It `failed` where there is none: rounding, where a size is absurd.
    """

    def __init__(self, matrix: Arrowhead, s: Vector) -> None:
        self.matrix, self.s = matrix, s
        inner, last = np.split(s[matrix.order], [matrix.inner])
        last = np.append(last, np.ones(matrix.followers))
        self._cross = matrix.cross * inner
        self._cross *= last[:, None]
        self._own, failed = list[NDArray](), 0
        for at, own in zip(matrix.blocks, matrix.own, strict=True):
            lower, not_positive = dpotrf(_scaled(own, inner[at]), lower=1, overwrite_a=1)
            # In its place: columns next to one another are one piece of memory here.
            dtrsm(1.0, lower, self._cross[:, at], side=1, lower=1, trans_a=1, overwrite_b=1)
            self._own.append(lower)
            failed += not_positive
        schur = _scaled(matrix.last, last)
        if matrix.inner:
            schur = dsyrk(-1.0, self._cross, beta=1.0, c=schur, lower=1, overwrite_c=1)
        self._last, not_positive = dpotrf(schur, lower=1, overwrite_a=1)
        self.failed = bool(failed + not_positive)

    @cached_property
    def log_determinant(self) -> float:
        """ln of the determinant of B."""
        diagonals = [lower.diagonal() for lower in (*self._own, self._last)]
        return 2.0 * float(np.log(np.concatenate(diagonals)).sum())

    def halve(self, right: NDArray) -> NDArray:
        """L^-1 times columns (q, k), with L L^T = B and the law beside it: (q + p, k)."""
        matrix = self.matrix
        half = np.zeros((right.shape[0] + matrix.followers, right.shape[1]))
        half[: right.shape[0]] = right[matrix.order]
        for at, lower in zip(matrix.blocks, self._own, strict=True):
            half[at] = dtrtrs(lower, half[at], lower=1)[0]
        half[matrix.inner :] -= self._cross @ half[: matrix.inner]
        half[matrix.inner :] = dtrtrs(self._last, half[matrix.inner :], lower=1)[0]
        return half

    def solve(self, right: NDArray) -> NDArray:
        """B^-1 times columns (q, k)."""
        matrix, solved = self.matrix, self.halve(right)
        solved[matrix.inner :] = dtrtrs(self._last, solved[matrix.inner :], lower=1, trans=1)[0]
        solved[: matrix.inner] -= self._cross.T @ solved[matrix.inner :]
        for at, lower in zip(matrix.blocks, self._own, strict=True):
            solved[at] = dtrtrs(lower, solved[at], lower=1, trans=1)[0]
        out = np.empty(right.shape)
        out[matrix.order] = solved[: right.shape[0]]
        return out

    @cached_property
    def diagonal(self) -> Vector:
        """Diagonal (q,) of what is left, from the triangular inverse: all of it would cost several times as much."""
        matrix, squares = self.matrix, np.zeros(self.s.size)
        if matrix.inner:
            below = dtrsm(1.0, self._last, self._cross, lower=1)
            for at, lower in zip(matrix.blocks, self._own, strict=True):
                inverse = dtrtri(lower, lower=1)[0]
                squares[at] = _squares(inverse)
                dtrmm(1.0, inverse, below[:, at], side=1, lower=1, overwrite_b=1)
            squares[: matrix.inner] += _squares(below)
        squares[matrix.inner :] = _squares(dtrtri(self._last, lower=1)[0])[: self.s.size - matrix.inner]
        diagonal = np.empty(self.s.size)
        diagonal[matrix.order] = 1.0 - squares
        return diagonal / self.s**2

    @cached_property
    def left(self) -> NDArray:
        """What is left (q, q)."""
        whole = np.eye(self.s.size)
        return (whole - self.solve(whole)) / self.s[:, None] / self.s


def _scaled(gram: NDArray, s: Vector) -> NDArray:
    """1 + S G S, in columns, as LAPACK wants it: the Gram matrix is symmetric, and nothing is copied."""
    whole = gram * s
    whole *= s[:, None]
    whole.ravel()[:: s.size + 1] += 1.0
    return whole.T


def _squares(columns: NDArray) -> Vector:
    """Sum of the squares of each column."""
    return np.asarray(np.einsum("ij,ij->j", columns, columns))
