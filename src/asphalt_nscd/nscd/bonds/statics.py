"""Static motions of a system under bonds that change: conjugate gradients, with factors that serve for a while."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import LinearOperator, SuperLU, cg

from asphalt_nscd.nscd.bonds.implicit_operator import factorise
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.system import BondedSystem


class Statics:
    """Static motion of a system per unit of its driven degree of freedom, each solution begun from the last.

    `tolerance` is relative, of the residual. The matrix is factorised anew after a solution that took more than
    `enough` iterations, and within one that took `most`.
    """

    def __init__(self, system: BondedSystem, tolerance: float, enough: int, most: int) -> None:
        """tolerance: of the residual, relative. The matrix is factorised anew after a solution that took more than
        `enough` iterations, and within one that took `most`.
        """
        self.system, self._tolerance, self._enough, self._most = system, tolerance, enough, most
        self._motion = np.zeros(system.mass.size)
        self._motion[system.driven] = 1.0
        self._transpose = system.operator.T.tocsr()
        self._factor: SuperLU | Multigrid | None = None

    def motion(self, weight: np.ndarray) -> np.ndarray:
        """Static displacements (d,) per unit of the driven one, for bonds of `weight` (3 b,) [m].

        ArithmeticError where no solution is found.
        """
        system, free = self.system, self.system.free
        # on the factors of other weights, if there are any; should they fail, once more on new ones
        for last in (self._factor is None, True):
            if self._factor is None:
                self._factor = factorise(system.stiffness(weight)[free][:, free].tocsc(), system)
            iterations, failed = self._solve(weight, self._factor)
            if failed or iterations > self._enough:
                self._factor = None
            if not failed:
                return self._motion.copy()  # the next solution goes on in place
            if last:
                break
        raise ArithmeticError("the static motion was not found")

    def _solve(self, weight: np.ndarray, factor: SuperLU | Multigrid) -> tuple[int, int]:
        """Go on from the last motion; how many iterations that took, and zero where it was enough."""
        system, free = self.system, self.system.free

        # by G and not by a matrix: conjugate gradients need products alone, so new weights cost no assembly
        def force(motion: np.ndarray) -> np.ndarray:
            return np.asarray(self._transpose @ (weight * (system.operator @ motion)))

        def of_free(part: np.ndarray) -> np.ndarray:
            whole = np.zeros_like(self._motion)
            whole[free] = part
            return force(whole)[free]

        head = np.zeros_like(self._motion)
        head[system.driven] = 1.0
        taken: list[None] = []
        matrix, near = ((free.size, free.size) for _ in range(2))
        self._motion[free], failed = cg(
            LinearOperator(matrix, of_free, dtype=float),
            -force(head)[free],
            x0=self._motion[free],
            rtol=self._tolerance,
            maxiter=self._most,
            M=LinearOperator(near, factor.solve, dtype=float),
            callback=lambda _: taken.append(None),
        )
        return len(taken), failed
