"""The matrix M + G^T (dt/S w) G of an implicit step, factorised, and kept up to date while bonds break."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.system import BondedSystem

LARGEST_FACTORED = 150_000  # unknowns; factors take 2 GB for 60 000 and beyond 16 for 210 000


def factorise(matrix: sparse.csc_matrix, system: BondedSystem) -> SuperLU | Multigrid:
    """What solves a positive definite matrix (f, f) on the free degrees of freedom of a system.

    Factors, or multigrid where they would not fit into memory; `.solve` takes one column or many.
    """
    if matrix.shape[0] > LARGEST_FACTORED and system.position is not None:
        return Multigrid(matrix, system.rigid_motions()[system.free])
    return factors(matrix)


def factors(matrix: sparse.csc_matrix) -> SuperLU:
    """Factors, with little fill, of a positive definite matrix (f, f), which needs no pivots."""
    # positive definite: pivots on the diagonal are safe, and keep the pattern symmetric
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


class ShiftedOperator:
    """M + G^T (scale w) G on the free degrees of freedom, solvable while bonds break.

    Factorised once. Each bond that breaks takes away three rank-one terms, which the Woodbury identity accounts for at
    the cost of three more solves; after many, it is factorised again. `scale` is dt/S [kg/m], one for all bonds or for
    each of their components (3 b,).
    """

    most_updates = 60  # breakages after which a new factorisation is cheaper

    def __init__(self, system: BondedSystem, scale: float | np.ndarray) -> None:
        self._system, self._scale = system, np.broadcast_to(scale, system.weight.shape)
        self._operator = system.operator[:, system.free]
        self._broken: list[int] = []
        self._strength: np.ndarray
        self._rows: sparse.csr_matrix
        self._capacitance: np.ndarray
        self._factorise()

    def remove(self, broken: list[int]) -> None:
        """Make these the bonds that are absent; the list `broken` may only grow.

        One by one: what results depends on the list alone, to the bit, not on how it came to be.
        """
        # at each 61st of the list, not when this object happens to need it: a restarted run has equal bits
        last = len(broken) // (self.most_updates + 1) * (self.most_updates + 1)
        if last > self._factored:
            self._broken = list(broken[:last])
            self._factorise()
        for bond in broken[len(self._broken) :]:
            self._broken.append(bond)
            self._take_away(bond)

    def release(self, impulse: np.ndarray) -> np.ndarray:
        """What an impulse (3,) of the bond last removed does to the solution (f,); a solve only if just factorised."""
        if not self._strength.size:  # factorised without it
            return self._factor.solve(self._operator[3 * self._broken[-1] + np.arange(3)].T @ impulse)
        own = self._responses[:, -3:] @ impulse
        return np.asarray(own + self._responses @ (self._capacitance @ (self._rows @ own)))

    def _take_away(self, bond: int) -> None:
        """Add the three rank-one terms of a bond to the update."""
        rows = 3 * bond + np.arange(3)
        taken, count = self._operator[rows], self._strength.size
        self._response[:, count : count + 3] = self._factor.solve(taken.T.toarray())
        self._rows = sparse.vstack([self._rows, taken], format="csr")
        self._strength = np.append(self._strength, self._scale[rows] * self.weight[rows])
        self.weight[rows] = 0.0
        self._capacitance = np.linalg.inv(np.diag(1.0 / self._strength) - self._rows @ self._responses)

    @property
    def _responses(self) -> np.ndarray:
        """Solutions (f, 3 n) for unit forces of the n bonds removed since the factorisation."""
        return self._response[:, : self._strength.size]

    def solve(self, force: np.ndarray) -> np.ndarray:
        """Solution for forces (f,) or (f, columns) on the free degrees of freedom, of the same shape."""
        solution = self._solve_once(force)
        if self._strength.size:  # the update cancels digits where bodies become nearly loose
            taken = self._rows.T @ ((self._strength * (self._rows @ solution).T).T)
            solution += self._solve_once(force - self._matrix @ solution + taken)
        return solution

    def _solve_once(self, force: np.ndarray) -> np.ndarray:
        solution = self._factor.solve(force)
        if self._strength.size:
            solution += self._responses @ (self._capacitance @ (self._rows @ solution))
        return solution

    def _factorise(self) -> None:
        """Factorise the matrix without the bonds broken so far, and begin an empty update."""
        system = self._system
        self.weight = system.weight.copy()
        for bond in self._broken:
            self.weight[3 * bond : 3 * bond + 3] = 0.0
        matrix = (sparse.diags_array(system.mass) + system.stiffness(self._scale * self.weight)).tocsc()
        self._matrix = matrix[system.free][:, system.free]
        self._factor, self._factored = factorise(self._matrix, system), len(self._broken)
        # by columns, and room for all that may be removed: a bond more copies nothing
        self._response = np.empty((system.free.size, 3 * self.most_updates), order="F")
        self._rows, self._strength = self._operator[:0], np.empty(0)
