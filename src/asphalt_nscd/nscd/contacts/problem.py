"""The frictional contact problem, and how far reactions are from solving it.

    u = W r + q,    K* ∋ u + mu |u_T| n  ⟂  r ∈ K,    K: |r_T| <= mu r_n

(de Saxcé's form of Signorini's and Coulomb's laws.) All vectors are ordered n, t1, t2 contact by
contact. W need not have full rank, nor be exactly symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import SuperLU, splu

from asphalt_nscd.nscd.contacts.gauss_seidel import accelerated_sweeps, natural_map

AnyMatrix: TypeAlias = Any  # dense, or sparse of any storage
LARGEST = 1e100  # of W, and its reciprocal the least: squares of more overflow


@dataclass(frozen=True)
class ContactProblem:
    """Checked input in the forms that the methods need.

    `matrix` W (3 c, 3 c) and its blocks `block` (blocks, 3, 3) in 1/kg, at block rows `row` and block columns `other`;
    `start` (c + 1,) is the first block of each row, `own` (c,) the place of W_aa. `free_velocity` q (3 c,) in m/s;
    `length` (c,) is the step length rho = 3 / tr W_aa [kg]; `part` (c,) numbers parts that W does not couple.
    """

    matrix: sparse.csr_array
    start: np.ndarray
    other: np.ndarray
    row: np.ndarray
    own: np.ndarray
    block: np.ndarray
    free_velocity: np.ndarray
    friction: np.ndarray
    length: np.ndarray
    part: np.ndarray

    @classmethod
    def of(cls, W: AnyMatrix, q: ArrayLike, mu: ArrayLike) -> ContactProblem:
        """Check a problem and bring it into the forms that the methods need; ValueError if it is none.

        `W` (3 c, 3 c) [1/kg] is of any storage; `q` (3 c,) in m/s; `mu` is one for all contacts or (c,).
        """
        q = np.array(q, float).ravel()
        contacts = q.size // 3
        if np.shape(W) != (3 * contacts, 3 * contacts) or q.size % 3:
            raise ValueError(f"W {np.shape(W)} and q ({q.size},) are not of three rows for each contact")
        if np.ndim(mu) and np.shape(mu) != (contacts,):
            raise ValueError(
                f"mu has the shape {np.shape(mu)}; give one number, or one for each of the {contacts} contacts"
            )
        if np.iscomplexobj(W if not sparse.issparse(W) else W.data):
            raise ValueError("W must be real")
        # a copy: broadcast arrays are read-only, which the compiled kernels would take for another type
        friction = np.broadcast_to(np.asarray(mu, float), contacts).copy()
        matrix = sparse.csr_array(W, dtype=float)
        blocks, row, own = _contact_blocks(matrix)
        if not (np.isfinite(blocks.data).all() and np.isfinite(q).all() and np.isfinite(friction).all()):
            raise ValueError("W, q and mu must be finite")
        if (friction < 0.0).any():
            raise ValueError("mu must not be negative")
        size = np.abs(blocks.data).max(initial=0.0)
        if size and not 1.0 / LARGEST < size < LARGEST:
            raise ValueError(f"W is of size {size:.0e}; give it in units in which it is nearer to one")
        trace = np.trace(blocks.data[own], axis1=1, axis2=2)
        usual = trace.mean() if trace.any() else 1.0
        # one over the mean eigenvalue of W_aa; that of all contacts where W_aa moves nothing
        length = 3.0 / np.where(trace > 1e-14 * usual, trace, usual)
        coupled = sparse.csr_array((np.ones(row.size), blocks.indices, blocks.indptr), (contacts, contacts))
        return cls(
            matrix,
            blocks.indptr.astype(np.int64),
            blocks.indices.astype(np.int64),
            row,
            own,
            blocks.data,
            q,
            friction,
            length,
            connected_components(coupled, directed=False)[1].astype(np.int64),
        )

    @property
    def _arrays(self) -> tuple[np.ndarray, ...]:
        """What the compiled kernels take first."""
        return self.start, self.other, self.block, self.free_velocity, self.friction, self.length, self.part

    def velocity(self, r: np.ndarray) -> np.ndarray:
        """Velocity u = W r + q (3 c,) [m/s] of reactions `r` (3 c,) [N s]."""
        return self.matrix @ r + self.free_velocity

    def errors(self, r: np.ndarray) -> tuple[float, float]:
        """Errors of reactions `r` (3 c,) [N s], as Siconos states it and free of units (`natural_map`)."""
        return natural_map(*self._arrays, r)  # type: ignore[call-arg]  # compiled

    def sweeps(self, tolerance: float, most_sweeps: int, first: np.ndarray) -> tuple[np.ndarray, int]:
        """Reactions (3 c,) [N s] by accelerated sweeps from `first` (3 c,), and the number of sweeps."""
        # compiled
        return accelerated_sweeps(*self._arrays, tolerance, most_sweeps, first)  # type: ignore[call-arg]

    def factor(self, block: np.ndarray, pressed: np.ndarray | None = None) -> SuperLU | None:
        """Factors of the matrix with `block` (blocks, 3, 3) in the places of W, or None if it is singular.

        The matrix keeps rows and columns of contacts `pressed` (c,), all if None. `.solve(right, "T")` solves with it:
        what are rows here are columns to SuperLU, which saves a transposition.
        """
        matrix = sparse.bsr_array((block, self.other, self.start), shape=self.matrix.shape).tocsr()
        if pressed is not None:
            rows = np.flatnonzero(np.repeat(pressed, 3))
            matrix = matrix[rows][:, rows]
        transposed = sparse.csc_array((matrix.data, matrix.indices, matrix.indptr), shape=matrix.shape)
        try:
            return splu(
                transposed, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1, options={"SymmetricMode": True}
            )  # the pattern is symmetric, the diagonal strong
        except RuntimeError:  # exactly singular
            return None


def _contact_blocks(matrix: sparse.csr_array) -> tuple[sparse.bsr_array, np.ndarray, np.ndarray]:
    """W in sorted 3 x 3 blocks, W_aa even where it is zero; the block row of each; the places (c,) of the W_aa."""
    blocks = sparse.bsr_array(matrix, blocksize=(3, 3))
    contacts = blocks.shape[0] // 3
    row, own = _places(blocks)
    if own.size < contacts:
        missing = np.setdiff1d(np.arange(contacts), row[own])
        row, column = np.r_[row, missing], np.r_[blocks.indices, missing]
        order = np.argsort(row, kind="stable")
        data = np.concatenate([blocks.data, np.zeros((missing.size, 3, 3))])[order]
        start = np.r_[0, np.cumsum(np.bincount(row, minlength=contacts))]
        blocks = sparse.bsr_array((data, column[order], start), shape=blocks.shape)
    if not blocks.has_sorted_indices or own.size < contacts:
        blocks.sort_indices()
        row, own = _places(blocks)
    return blocks, row, own


def _places(blocks: sparse.bsr_array) -> tuple[np.ndarray, np.ndarray]:
    row = np.repeat(np.arange(blocks.shape[0] // 3), np.diff(blocks.indptr))
    return row, np.flatnonzero(row == blocks.indices)
