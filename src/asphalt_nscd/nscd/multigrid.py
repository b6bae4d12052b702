"""Conjugate gradients with smoothed aggregation, for systems whose factors would not fit into memory.

The near-nullspace is that of bonded bodies: six motions of the whole as one rigid body.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import cg

TOLERANCE = 1e-12  # of the residual, relative to the right-hand side
MOST_ITERATIONS = 1000
PER_BODY = 6


class Multigrid:
    """A symmetric positive definite matrix that is solved as factors are, by `.solve`."""

    def __init__(self, matrix: sparse.csc_matrix, modes: np.ndarray) -> None:
        """matrix (f, f); modes (f, 6): the rigid-body motions of its degrees of freedom, six a body.

        Bodies come one after another; the last may lack some of its six.
        """
        import pyamg  # only large systems need it

        self._size = matrix.shape[0]
        missing = -self._size % PER_BODY
        filled = sparse.block_diag([matrix, matrix.diagonal().mean() * sparse.eye_array(missing)])
        self._matrix = filled.tobsr((PER_BODY, PER_BODY))
        self._matrix.indptr, self._matrix.indices = (
            index.astype(np.int32) for index in (self._matrix.indptr, self._matrix.indices)
        )
        smoother = ("block_gauss_seidel", {"sweep": "symmetric"})
        self.levels = pyamg.smoothed_aggregation_solver(
            self._matrix, B=np.pad(modes, ((0, missing), (0, 0))), strength=("symmetric", {"theta": 0.0}),
            presmoother=smoother, postsmoother=smoother, improve_candidates=None, max_coarse=60,
            coarse_solver="splu",
        )  # fmt: skip
        self._near = self.levels.aspreconditioner()

    def solve(self, force: np.ndarray) -> np.ndarray:
        """Solution for one force (f,) or several (f, columns); ArithmeticError where it is not reached."""
        if force.ndim == 2:
            return np.column_stack([self.solve(column) for column in force.T])
        filled = np.pad(force, (0, self._matrix.shape[0] - self._size))
        solution, failed = cg(
            self._matrix, filled, rtol=TOLERANCE, atol=0.0, maxiter=MOST_ITERATIONS, M=self._near
        )
        if failed:
            raise ArithmeticError(f"multigrid: no solution within {MOST_ITERATIONS} iterations")
        return solution[: self._size]
