"""Reduced (Ritz/Krylov) form of the bonded system, with a certificate at every step.

Since all bonds share one rheology, displacements, velocities, bond stresses and Kelvin
displacements of the whole specimen live in the span of the same few vectors: u = Phi q,
sigma = G Phi s [N/m], dk = G Phi kappa [m], whatever the law. The reduced equations are the Galerkin
projection of the condensed ones and are stepped by the same scheme.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, cg

from asphalt_nscd.nscd.bonds.implicit_operator import factorise
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.strength import bound
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.stepping.bond_bounds import BondBounds
from asphalt_nscd.nscd.stepping.projection import Projection, rows_of

DEPENDENT = 1e-9  # part of a direction that is new, at most, where it is left out
SHIFT = 1e-2  # m/kg, S/dt of a typical law: for it, the first step from rest or after a break is exact


def shifted_factor(system: BondedSystem) -> SuperLU | Multigrid:
    """What solves K + SHIFT M on the free degrees of freedom."""
    free = system.free
    matrix = (system.stiffness() + SHIFT * sparse.diags_array(system.mass)).tocsc()[free][:, free]
    return factorise(matrix, system)


def ritz_basis(
    system: BondedSystem, iterations: int, shifted: SuperLU | Multigrid | None = None
) -> np.ndarray:
    """Phi (d, 2 + 2 iterations at most): the static response to the driven motion, then Krylov vectors.

    Column 0 has unit motion of the driven degree of freedom; the others leave it at rest. They come from the inertia of
    column 0 and from the constant load by repeated (K + SHIFT M)^-1 M, which `shifted` solves where it stands already.
    ArithmeticError where some body is not held by its bonds.
    """
    free, k = system.free, system.stiffness()
    mass = system.mass[free]
    stiffness = k[free][:, free]
    coupling = k[free][:, [system.driven]].toarray()[:, 0]
    shifted = shifted_factor(system) if shifted is None else shifted
    # K alone is not factorised: K + SHIFT M differs from it so little that a few iterations make up for it,
    # and is needed anyway
    close = shifted.cycle if isinstance(shifted, Multigrid) else shifted.solve
    near = LinearOperator(stiffness.shape, matvec=close)

    def static(force: np.ndarray) -> np.ndarray:
        motion = cg(stiffness, force, rtol=1e-13, atol=0.0, M=near, maxiter=500)[0]
        # a body that no bond holds makes K singular; conjugate gradients then end anywhere
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
    columns = Columns(system, basis)
    columns.append(embed(static(system.load[free])[:, None]))
    basis = columns.basis
    block = np.column_stack([mass * basis[free, 0], system.load[free]])
    for _ in range(iterations):
        new = columns.append(embed(shifted.solve(block)))
        block = mass[:, None] * new[free]  # of the orthonormal ones: they do not align
    return columns.basis


class Columns:
    """A basis (d, k) that grows by columns orthonormal in the stiffness of the unbroken system."""

    def __init__(self, system: BondedSystem, basis: np.ndarray) -> None:
        """basis (d, k): column 0 moves the driven degree of freedom, the others are orthonormal."""
        self._system, self._root = system, np.sqrt(system.weight)[:, None]
        self._parts, self._stretched = [basis], [self._stretch(basis[:, 1:])]

    @property
    def basis(self) -> np.ndarray:
        """All columns (d, k)."""
        return np.column_stack(self._parts)

    def _stretch(self, motion: np.ndarray) -> np.ndarray:
        """Columns whose inner products are those of the motions (d, n) in the stiffness."""
        return np.asarray(self._root * (self._system.operator @ motion))

    def append(self, extra: np.ndarray) -> np.ndarray:
        """Take in what is new of directions (d, m), and give the columns (d, n) that it becomes."""
        new = self.new_in(extra)
        self._parts.append(new)
        self._stretched.append(self._stretch(new))
        return new

    def new_in(self, extra: np.ndarray) -> np.ndarray:
        """Part of directions `extra` (d, m) that the basis lacks, as orthonormal columns (d, n), n <= m.

        Directions of which no more than the part DEPENDENT is new are left out: normalised, they would be rounding
        errors, and the projection would lose its condition.
        """
        # a system without load brings a column of zeros, which has no length to divide by
        extra = extra[:, extra.any(axis=0)]
        parts = [self._parts[0][:, 1:], *self._parts[1:]]
        for _ in range(4):  # each pass removes what rounding left of the one before
            if not extra.size:
                break
            stretched = self._stretch(extra)
            length = np.linalg.norm(stretched, axis=0)
            if not length.all():  # columns of 1e-160 have squares of zero
                extra, stretched, length = (
                    extra[:, length > 0.0],
                    stretched[:, length > 0.0],
                    length[length > 0.0],
                )
            for part, known in zip(parts, self._stretched, strict=True):
                share = known.T @ stretched
                extra, stretched = extra - part @ share, stretched - known @ share
            stretched /= length
            extra = extra / length
            _, size, directions = np.linalg.svd(np.linalg.qr(stretched, mode="r"), full_matrices=False)
            # singular values, not columns, say what is new: two columns may each be new and yet the same
            kept = size > DEPENDENT
            extra = extra @ (directions[kept].T / size[kept])
        return extra


def append_columns(system: BondedSystem, basis: np.ndarray, extra: np.ndarray) -> np.ndarray:
    """`basis` (d, k) with what directions `extra` (d, m) add to it (d, k + n); see `Columns`."""
    columns = Columns(system, basis)
    columns.append(extra)
    return columns.basis


class ReducedModel:
    """A bonded system projected on a basis, with some bonds removed.

    Column 0 of `basis` (d, k) moves the driven degree of freedom by one, the others leave it. `projection` is that of
    the system without `broken` on this basis, where it is known already.
    """

    def __init__(
        self,
        system: BondedSystem,
        basis: np.ndarray,
        broken: Sequence[int] = (),
        projection: Projection | None = None,
    ) -> None:
        if not (system.gap > 0.0).all():
            raise ValueError("gap: the reduced model counts shares of gaps, so that none may be zero.")
        self.system, self.basis = system, basis
        small = Projection.of(system, basis, broken) if projection is None else projection
        self.mass, self.stiffness, self.load = small.mass, small.stiffness, small.load
        self.residual_factor = small.residual_factor
        self.head_norm, self.load_norm = small.head_norm, small.load_norm
        self.weight = system.weight.copy()
        self.weight[rows_of(broken)] = 0.0
        self.opening = system.operator @ basis  # G Phi (3 b, k)
        utilised, closed = _contributions(self.opening, self._share_of_strength, system.gap)
        self.bounds = BondBounds(np.arange(system.gap.size), utilised, closed, system.gap)

    @property
    def size(self) -> int:
        """Number k of coordinates."""
        return self.load.size

    @property
    def _share_of_strength(self) -> np.ndarray:
        """Share of the strength that a unit of stress takes (b, 3)."""
        return self.weight.reshape(-1, 3) / self.system.strength[:, None]

    def reaction_of(self, bonds: np.ndarray) -> np.ndarray:
        """Reactions (n, 3, k) of bonds (n,) over their strength, per unit s."""
        return self._share_of_strength[bonds, :, None] * self.opening.reshape(-1, 3, self.load.size)[bonds]

    def closing_of(self, bonds: np.ndarray) -> np.ndarray:
        """Shares (n, k) of the gaps of bonds (n,) that close per unit q."""
        return -self.opening[3 * bonds] / self.system.gap[bonds, None]

    def residual_norm(self, force: np.ndarray) -> float:
        """Norm of a residual `force` (d,) of the full equations, each row over the root of its stiffness."""
        free = self.system.free
        return float(np.linalg.norm(force[free] / np.sqrt(self.system.stiffness_diagonal[free])))

    def project_anew(self, basis: np.ndarray, broken: Sequence[int]) -> ReducedModel:
        """The same system projected anew on another `basis` (d, k), with bonds `broken` removed."""
        return ReducedModel(self.system, basis, broken)


@compiled
def _contributions(opening, share_of_strength, gap):
    """Yield measure of each bond, and share of its gap that closes, for each coordinate alone: (b, k) each."""
    bonds, k = gap.shape[0], opening.shape[1]
    utilised, closed = np.empty((bonds, k)), np.empty((bonds, k))
    for b in range(bonds):
        for a in range(k):
            utilised[b, a] = bound(
                share_of_strength[b, 0] * opening[3 * b, a],
                share_of_strength[b, 1] * opening[3 * b + 1, a],
                share_of_strength[b, 2] * opening[3 * b + 2, a],
            )
            closed[b, a] = abs(opening[3 * b, a]) / gap[b]
    return utilised, closed
