"""Conjugate gradients with smoothed aggregation, for systems whose factors would not fit into memory.

The near-nullspace is that of bonded bodies: six motions of the whole as one rigid body. Translations
and rotations of a body are first scaled with the factors of its own 6x6 block, L L^T: then a
polynomial in the matrix smooths as well as Gauss-Seidel, at the cost of products.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import cg

TOLERANCE = 1e-12  # of the scaled residual, relative to the scaled right-hand side
MOST_ITERATIONS = 1000
PER_BODY = 6
SMOOTHER = ("chebyshev", {"degree": 4})  # half the time of a solution with Gauss-Seidel


class Multigrid:
    """A symmetric positive definite matrix (f, f) that is solved as factors are, by `.solve`.

    Its bodies come one after another; the last may lack some of its six degrees of freedom. `modes` (f, 6) are its
    rigid-body motions.
    """

    def __init__(self, matrix: sparse.csc_matrix, modes: np.ndarray) -> None:
        self._size = matrix.shape[0]
        self._matrix = _body_blocks(matrix)
        bodies = self._matrix.shape[0] // PER_BODY
        row = np.repeat(np.arange(bodies), np.diff(self._matrix.indptr))
        own = self._matrix.data[row == self._matrix.indices]
        factor = np.linalg.cholesky(own)
        self._inverse = np.linalg.inv(factor)
        self._matrix.data = self._inverse[row] @ self._matrix.data
        self._matrix.data = self._matrix.data @ self._inverse[self._matrix.indices].transpose(0, 2, 1)
        # a motion u is L^T u in the unknowns of the scaled matrix, L^-1 K L^-T
        scaled_modes = _times(factor.transpose(0, 2, 1), np.pad(modes, ((0, -self._size % PER_BODY), (0, 0))))
        self.levels = _aggregated(self._matrix, scaled_modes)
        self._near = self.levels.aspreconditioner()

    def cycle(self, force: np.ndarray) -> np.ndarray:
        """One cycle: an approximate solution (f,) of `force` (f,), which serves to precondition."""
        return self._unscaled(self._near @ self._scaled(force))

    def solve(self, force: np.ndarray) -> np.ndarray:
        """Solution for `force` (f,) or (f, columns); ArithmeticError after MOST_ITERATIONS of conjugate gradients."""
        if force.ndim == 2:
            return np.column_stack([self.solve(column) for column in force.T])
        scaled = self._scaled(force)
        solution, failed = cg(
            self._matrix, scaled, rtol=TOLERANCE, atol=0.0, maxiter=MOST_ITERATIONS, M=self._near
        )
        if failed:
            raise ArithmeticError(f"multigrid: no solution within {MOST_ITERATIONS} iterations")
        return self._unscaled(solution)

    def _scaled(self, force: np.ndarray) -> np.ndarray:
        return _times(self._inverse, np.pad(force, (0, self._matrix.shape[0] - self._size))[:, None])[:, 0]

    def _unscaled(self, motion: np.ndarray) -> np.ndarray:
        return _times(self._inverse.transpose(0, 2, 1), motion[:, None])[: self._size, 0]


def _body_blocks(matrix: sparse.csc_matrix) -> sparse.bsr_matrix:
    """The matrix in 6 x 6 blocks, one for each pair of bodies; what the last body lacks of its six stands alone."""
    size, entries = matrix.shape[0], matrix.nnz
    missing = np.arange(-size % PER_BODY)
    rows = matrix.T  # symmetric: its columns are its rows
    whole = sparse.csr_matrix(
        (
            np.append(rows.data, np.full(missing.size, rows.data.max())),
            np.append(rows.indices, size + missing),
            np.append(rows.indptr, entries + missing + 1),
        ),
        shape=(size + missing.size,) * 2,
    )
    return whole.tobsr((PER_BODY, PER_BODY))


def _times(blocks: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """The block-diagonal matrix of blocks (n, 6, 6) times columns (6 n, k)."""
    return (blocks @ columns.reshape(-1, PER_BODY, columns.shape[1])).reshape(columns.shape)


def _aggregated(matrix: sparse.bsr_matrix, modes: np.ndarray) -> Any:
    """Levels of the multigrid; equal to the bit in each run, though spectral radii come from random vectors."""
    import pyamg  # only large systems need it

    # pyamg draws from numpy's global state, which is the caller's
    random = np.random.get_state()
    np.random.seed(0)
    try:
        return pyamg.smoothed_aggregation_solver(
            matrix,
            B=modes,
            strength=("symmetric", {"theta": 0.0}),
            presmoother=SMOOTHER,
            postsmoother=SMOOTHER,
            improve_candidates=None,
            max_coarse=60,
            coarse_solver="splu",
        )
    finally:
        np.random.set_state(random)
