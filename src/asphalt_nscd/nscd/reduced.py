"""Reduced (Ritz/Krylov) form of the bonded system, with a certificate at every step.

Since all bonds share one rheology, displacements, velocities, bond stresses and Kelvin
displacements of the whole specimen live in the span of the same few vectors: u = Phi q,
sigma = G Phi s, dk = G Phi kappa, whatever the law. The reduced equations are the Galerkin
projection of the condensed ones and are stepped by the same scheme.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, cg

from asphalt_nscd.nscd.bonds import BondedSystem
from asphalt_nscd.nscd.shifted import factorise

DEPENDENT = 1e-9


def ritz_basis(system: BondedSystem, iterations: int, shift: float = 1e-2) -> np.ndarray:
    """Phi (d, 2 + 2 iterations): the static response to the driven motion, then Krylov vectors.

    Column 0 has unit motion of the driven degree of freedom; the others leave it at rest. They
    come from the inertia of column 0 and from the constant load by repeated (K + shift M)^-1 M;
    `shift` [m/kg] is S/dt of a typical law, for which the first step from rest is then exact.
    """
    free, k = system.free, system.stiffness()
    mass = system.mass[free]
    stiffness = k[free][:, free]
    coupling = k[free][:, [system.driven]].toarray()[:, 0]
    shifted = factorise((stiffness + shift * sparse.diags_array(mass)).tocsc())
    near = LinearOperator(stiffness.shape, matvec=shifted.solve)

    def static(force: np.ndarray) -> np.ndarray:
        motion = cg(stiffness, force, rtol=1e-13, atol=0.0, M=near, maxiter=500)[0]
        if np.linalg.norm(stiffness @ motion - force) > 1e-8 * np.linalg.norm(force):
            raise ArithmeticError("static equations not solved: some body is not held by its bonds")
        return motion

    def embed(motion: np.ndarray) -> np.ndarray:
        columns = np.zeros((system.mass.size, motion.shape[1]))
        columns[free] = motion
        return columns

    basis = np.zeros((system.mass.size, 1))
    basis[system.driven, 0] = 1.0
    basis[free, 0] = static(-coupling)
    basis = append_columns(system, basis, embed(static(system.load[free])[:, None]))
    block = np.column_stack([mass * basis[free, 0], system.load[free]])
    for _ in range(iterations):
        known = basis.shape[1]
        basis = append_columns(system, basis, embed(shifted.solve(block)))
        block = mass[:, None] * basis[free, known:]  # of the orthonormal ones: they do not align
    return basis


def append_columns(system: BondedSystem, basis: np.ndarray, extra: np.ndarray) -> np.ndarray:
    """Columns added after orthonormalising them in the stiffness of the unbroken system.

    Directions of which no more than the part DEPENDENT is new are left out: normalised, they would
    be rounding errors, and the projection would lose its condition.
    """
    root = np.sqrt(system.weight)[:, None]
    known = root * (system.operator @ basis[:, 1:])
    extra = extra[:, extra.any(axis=0)]
    for _ in range(4):  # each pass removes what rounding left of the one before
        if not extra.size:
            break
        stretched = root * (system.operator @ extra)
        length = np.linalg.norm(stretched, axis=0)
        share = known.T @ stretched
        extra = (extra - basis[:, 1:] @ share) / length
        stretched = (stretched - known @ share) / length
        _, size, directions = np.linalg.svd(np.linalg.qr(stretched, mode="r"), full_matrices=False)
        kept = size > DEPENDENT
        extra = extra @ (directions[kept].T / size[kept])
    return np.column_stack([basis, extra])


class ReducedModel:
    """A bonded system projected on a basis, with some bonds removed."""

    def __init__(self, system: BondedSystem, basis: np.ndarray, broken: Sequence[int] = ()) -> None:
        """basis (d, k): column 0 moves the driven degree of freedom by one, the others leave it."""
        self.system, self.basis = system, basis
        self.weight = system.weight.copy()
        for bond in broken:
            self.weight[3 * bond : 3 * bond + 3] = 0.0
        self.opening = system.operator @ basis  # G Phi (3 b, k)
        weighted = self.weight[:, None] * self.opening
        self.mass = basis.T @ (system.mass[:, None] * basis)
        self.stiffness = self.opening.T @ weighted
        self.load = basis.T @ system.load
        # residual of the full equations = [M Phi, -K Phi, -f] (a, s, 1); its norm, each row over the
        # root of its stiffness, is that of a small triangular factor times (a, s, 1)
        free = system.free
        self._root = root = np.sqrt((system.operator.power(2).T @ system.weight)[free])
        columns = [system.mass[:, None] * basis, -(system.operator.T @ weighted), -system.load[:, None]]
        self.residual_factor = np.linalg.qr(np.hstack(columns)[free] / root[:, None], mode="r")
        head = system.operator.T @ (system.weight * system.operator[:, [system.driven]].toarray()[:, 0])
        self.head_norm = float(np.linalg.norm(head[free] / root))
        self.load_norm = float(np.linalg.norm(system.load[free] / root))
        # per unit s: reactions over strength; per unit q: share of the gap that closes
        self.reaction = weighted.reshape(-1, 3, basis.shape[1]) / system.strength[:, None, None]
        self.closing = -self.opening[::3] / system.gap[:, None]

    def residual_norm(self, force: np.ndarray) -> float:
        """The norm that `residual_factor` gives, of any residual (d,)."""
        return float(np.linalg.norm(force[self.system.free] / self._root))

    def with_basis(self, basis: np.ndarray, broken: Sequence[int]) -> ReducedModel:
        """The same system on another basis with the bonds `broken` removed."""
        return ReducedModel(self.system, basis, broken)

    def utilisation_bound(self, sigma: np.ndarray) -> np.ndarray:
        """Upper bound (b,) of the yield measure while |s| <= sigma (k,)."""
        return np.sqrt(((np.abs(self.reaction) @ sigma) ** 2).sum(axis=1))

    def candidates(self, sigma: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bonds that could yield, and gaps that could close, while |s| <= sigma and |q| <= motion."""
        may_yield = np.flatnonzero(self.utilisation_bound(sigma) > 1.0)
        may_close = np.flatnonzero(np.abs(self.closing) @ motion > 1.0)
        return may_yield, may_close
