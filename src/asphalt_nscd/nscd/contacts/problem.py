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
    """Checked input in the forms that the methods need."""

    matrix: sparse.csr_array  # W (3 c, 3 c) [1/kg]
    start: np.ndarray  # (c + 1,) first block of each block row of W
    other: np.ndarray  # (blocks,) block column
    row: np.ndarray  # (blocks,) block row
    own: np.ndarray  # (c,) where in these lists W_aa stands
    block: np.ndarray  # (blocks, 3, 3)
    free_velocity: np.ndarray  # q (3 c,) [m/s]
    friction: np.ndarray  # mu (c,)
    length: np.ndarray  # rho (c,) [kg]: 3 / tr W_aa, the step length that suits each contact
    part: np.ndarray  # (c,) number of the part that a contact is in: W couples no two parts

    @classmethod
    def of(cls, W: AnyMatrix, q: ArrayLike, mu: ArrayLike) -> ContactProblem:
        """From a matrix of any storage and a coefficient of friction, or one for each contact."""
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
        friction = np.broadcast_to(np.asarray(mu, float), contacts).copy()
        matrix = sparse.csr_array(W, dtype=float)
        blocks, row, own = _with_own_blocks(matrix)
        if not (np.isfinite(blocks.data).all() and np.isfinite(q).all() and np.isfinite(friction).all()):
            raise ValueError("W, q and mu must be finite")
        if (friction < 0.0).any():
            raise ValueError("mu must not be negative")
        size = np.abs(blocks.data).max(initial=0.0)
        if size and not 1.0 / LARGEST < size < LARGEST:
            raise ValueError(f"W is of size {size:.0e}; give it in units in which it is nearer to one")
        trace = np.trace(blocks.data[own], axis1=1, axis2=2)
        usual = trace.mean() if trace.any() else 1.0
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

    def velocity(self, r: np.ndarray) -> np.ndarray:
        """u = W r + q."""
        return self.matrix @ r + self.free_velocity

    def errors(self, r: np.ndarray) -> tuple[float, float]:
        """Error of the natural map as Siconos states it, and free of units; see `natural_map`."""
        return natural_map(
            self.start, self.other, self.block, self.free_velocity, self.friction, self.length, self.part, r
        )

    def sweeps(self, tolerance: float, most_sweeps: int, first: np.ndarray) -> tuple[np.ndarray, int]:
        """Reactions by accelerated sweeps from `first` (3 c,), and how many."""
        return accelerated_sweeps(
            self.start,
            self.other,
            self.block,
            self.free_velocity,
            self.friction,
            self.length,
            self.part,
            tolerance,
            most_sweeps,
            first,
        )

    def factor(self, block: np.ndarray, pressed: np.ndarray | None = None) -> SuperLU | None:
        """Factors of the matrix with other blocks in the places of W; None if it is singular.

        pressed (c,): contacts whose rows and columns it has. `.solve(right, "T")` solves with it: what
        are rows here are columns to SuperLU, which saves a transposition.
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


def _with_own_blocks(matrix: sparse.csr_array) -> tuple[sparse.bsr_array, np.ndarray, np.ndarray]:
    """As 3 x 3 blocks in order, W_aa among them even where it is zero; their rows; where the W_aa stand."""
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
