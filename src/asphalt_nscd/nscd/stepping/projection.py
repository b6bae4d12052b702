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
    """Column 0 of Phi (d, k) moves the driven degree of freedom by one, the others leave it.

    Some bonds can still be removed: the factor then has a column for each of their components, the reaction
    of which the last terms of (a, s, 1, reaction) take away.

    Parameters
    ----------
    mass : ndarray (k, k)
        [kg].
    stiffness : ndarray (k, k)
        [m].
    load : ndarray (k,)
        [N].
    residual_factor : ndarray (., 2 k + 1 + 3 n)
        Upper triangular.
    opening : ndarray (3 n, k)
        G Phi of the removable bonds.
    weight : ndarray (3 n,)
        Of the removable bonds [m].
    head_norm : float
        Of what one unit of s_0 asks of the driven degree of freedom alone.
    load_norm : float
        Of f.
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
        """Project a system.

        Parameters
        ----------
        system : BondedSystem
            Bonds and masses.
        basis : ndarray (d, k)
            Phi.
        broken : sequence of int
            Bonds that are gone.
        removable : sequence of int (n,)
            Bonds that are there, and can be removed.

        Returns
        -------
        Projection
            Small matrices.
        """
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
        """The projection on Phi `mixing` without some of the removable bonds.

        Parameters
        ----------
        mixing : ndarray (k, j)
            Columns.
        removed : ndarray of int
            Places among the removable bonds.

        Returns
        -------
        Projection
            On j columns.
        """
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
    """Rows of G that belong to bonds.

    Parameters
    ----------
    bonds : sequence of int (n,)
        Which.

    Returns
    -------
    ndarray of int (3 n,)
        Three each.
    """
    return (3 * np.asarray(bonds, int)[:, None] + np.arange(3)).ravel()
