"""A bonded system projected on columns: the small matrices of its equations, and of what they miss.

With accelerations Phi a and stresses G Phi s the full equations miss r = M Phi a - K Phi s - f on the
free degrees of freedom. Its norm, each row over the root of its stiffness, is that of a triangular
factor of [M Phi, -K Phi, -f] times (a, s, 1), to rounding, which no Gram matrix would give.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from asphalt_nscd.nscd.bonds.system import BondedSystem


@dataclass(frozen=True)
class Projection:
    """Small matrices of a system on Phi (d, k), whose column 0 alone moves the driven degree of freedom, by one.

    `mass` in kg, `stiffness` in m, `load` (k,) in N; `residual_factor` (r, 2 k + 1 + 3 n) is upper triangular, with a
    column for each component of n removable bonds, whose reaction the last terms of (a, s, 1, reaction) take away;
    `opening` (3 n, k) is their G Phi, `weight` (3 n,) [m] their w. `head_norm` is of what one unit of s_0 asks of the
    driven degree of freedom alone, `load_norm` of f.
    """

    mass: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    residual_factor: np.ndarray
    opening: np.ndarray
    weight: np.ndarray
    head_norm: float
    load_norm: float

    @classmethod
    def of(
        cls, system: BondedSystem, basis: np.ndarray, broken: Sequence[int], removable: Sequence[int] = ()
    ) -> Projection:
        """Project a system without `broken` bonds on Phi = `basis` (d, k); `removable` ones (n,) may go later."""
        free, operator = system.free, system.operator
        weight = system.weight.copy()
        weight[rows_of(broken)] = 0.0
        # forces and couples over the root of their stiffness have one unit, that of the root of an energy
        root = np.sqrt(system.stiffness_diagonal[free])
        rows = rows_of(removable)
        opening = operator @ basis
        weighted = weight[:, None] * opening
        # of the sound system: the measure of residuals stays what it is as bonds break
        head = operator.T @ (system.weight * operator[:, [system.driven]].toarray()[:, 0])
        columns = [
            system.mass[:, None] * basis,
            -(operator.T @ weighted),
            -system.load[:, None],
            operator[rows].T.toarray(),
        ]
        return cls(
            mass=basis.T @ columns[0],
            stiffness=opening.T @ weighted,
            load=basis.T @ system.load,
            residual_factor=np.asarray(np.linalg.qr(np.hstack(columns)[free] / root[:, None], mode="r")),
            opening=opening[rows],
            weight=weight[rows],
            head_norm=float(np.linalg.norm(head[free] / root)),
            load_norm=float(np.linalg.norm(system.load[free] / root)),
        )

    def combined(self, mixing: np.ndarray, removed: np.ndarray) -> Projection:
        """The projection on the product of Phi and `mixing` (k, j), without the removable bonds at places `removed`."""
        rows = rows_of(removed)
        opening = self.opening[rows]
        reaction = self.weight[rows, None] * opening
        k = self.load.size
        inertia, stress, load, bonds = np.split(self.residual_factor, [k, 2 * k, 2 * k + 1], axis=1)
        columns = [inertia @ mixing, (stress + bonds[:, rows] @ reaction) @ mixing, load]
        return Projection(
            mass=mixing.T @ self.mass @ mixing,
            stiffness=mixing.T @ (self.stiffness - opening.T @ reaction) @ mixing,
            load=mixing.T @ self.load,
            residual_factor=np.asarray(np.linalg.qr(np.hstack(columns), mode="r")),
            opening=np.empty((0, mixing.shape[1])),
            weight=np.empty(0),
            head_norm=self.head_norm,
            load_norm=self.load_norm,
        )


def rows_of(bonds: Sequence[int] | np.ndarray) -> np.ndarray:
    """Rows (3 n,) of G that belong to bonds (n,), three each."""
    return (3 * np.asarray(bonds, int)[:, None] + np.arange(3)).ravel()
