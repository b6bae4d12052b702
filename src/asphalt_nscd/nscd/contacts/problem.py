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

    Parameters
    ----------
    matrix : csr_array (3 c, 3 c)
        W [1/kg].
    start : ndarray of int (c + 1,)
        First block of each block row of W.
    other : ndarray of int (blocks,)
        Block column.
    row : ndarray of int (blocks,)
        Block row.
    own : ndarray of int (c,)
        Where in these lists W_aa stands.
    block : ndarray (blocks, 3, 3)
        The blocks [1/kg].
    free_velocity : ndarray (3 c,)
        q [m/s].
    friction : ndarray (c,)
        mu.
    length : ndarray (c,)
        rho = 3 / tr W_aa [kg], the step length that suits each contact.
    part : ndarray of int (c,)
        Number of the part that a contact is in: W couples no two parts.
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
        """Check a problem and bring it into the forms that the methods need.

        Parameters
        ----------
        W : array or sparse matrix (3 c, 3 c)
            Delassus operator [1/kg], of any storage.
        q : array_like (3 c,)
            Free velocities [m/s].
        mu : float or array_like (c,)
            Friction, one for all contacts or for each.

        Returns
        -------
        ContactProblem
            Blocks, step lengths and parts.

        Raises
        ------
        ValueError
            For shapes that do not fit, or values that are not finite or not real.
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

    def velocity(self, r: np.ndarray) -> np.ndarray:
        """u = W r + q.

        Parameters
        ----------
        r : ndarray (3 c,)
            Reactions [N s].

        Returns
        -------
        ndarray
            (3 c,) [m/s].
        """
        return self.matrix @ r + self.free_velocity

    def errors(self, r: np.ndarray) -> tuple[float, float]:
        """Errors of the natural map; see `natural_map`.

        Parameters
        ----------
        r : ndarray (3 c,)
            Reactions [N s].

        Returns
        -------
        tuple of float
            As Siconos states it, and free of units.
        """
        return natural_map(
            self.start, self.other, self.block, self.free_velocity, self.friction, self.length, self.part, r
        )

    def sweeps(self, tolerance: float, most_sweeps: int, first: np.ndarray) -> tuple[np.ndarray, int]:
        """Reactions by accelerated sweeps.

        Parameters
        ----------
        tolerance : float
            Of both errors.
        most_sweeps : int
            How many at most.
        first : ndarray (3 c,)
            Reactions to start from [N s].

        Returns
        -------
        ndarray (3 c,)
            Reactions [N s].
        int
            Sweeps.
        """
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
        """Factors of the matrix with other blocks in the places of W.

        `.solve(right, "T")` solves with it: what are rows here are columns to SuperLU, which saves a
        transposition.

        Parameters
        ----------
        block : ndarray (blocks, 3, 3)
            In the places of W.
        pressed : ndarray of bool (c,), optional
            Contacts whose rows and columns it has; all if None.

        Returns
        -------
        SuperLU or None
            None if it is singular.
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
