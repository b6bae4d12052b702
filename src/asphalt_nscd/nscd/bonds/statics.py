"""Static motions of a system under bonds that change: conjugate gradients, with factors that serve for a while."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import LinearOperator, SuperLU, cg

from asphalt_nscd.nscd.bonds.implicit_operator import factorise
from asphalt_nscd.nscd.bonds.multigrid import Multigrid
from asphalt_nscd.nscd.bonds.system import BondedSystem

EXACT = 1e-13  # residual of one static solution, relative
MOST_ITERATIONS = 50  # of it, on factors of its own: two or three serve


def static_factor(system: BondedSystem, weight: np.ndarray) -> SuperLU | Multigrid:
    """What solves the stiffness of bonds of `weight` (3 b,) [m] on the free degrees of freedom."""
    free = system.free
    return factorise(system.stiffness(weight)[free][:, free].tocsc(), system)


def static_motion(system: BondedSystem) -> np.ndarray:
    """Static displacements (d,) of a system whose driven degree of freedom moves by one."""
    return Statics(system, EXACT, MOST_ITERATIONS, MOST_ITERATIONS).motion(system.weight)


def static_stiffness(system: BondedSystem, motion: np.ndarray) -> float:
    """Static stiffness per unit modulus [m]: twice the energy of `motion` (d,) of unit head displacement."""
    opening = system.operator @ motion
    return float(system.weight @ opening**2)


class Statics:
    """Static motion of a system per unit of its driven degree of freedom, each solution begun from the last.

    `tolerance` is relative, of the residual. The matrix is factorised anew after a solution that took more than
    `enough` iterations, and within one that took `most`.
    """

    def __init__(self, system: BondedSystem, tolerance: float, enough: int, most: int) -> None:
        self.system, self._tolerance, self._enough, self._most = system, tolerance, enough, most
        self._motion = np.zeros(system.mass.size)
        self._motion[system.driven] = 1.0
        self._transpose = system.operator.T.tocsr()
        self._factor: SuperLU | Multigrid | None = None

    def motion(self, weight: np.ndarray) -> np.ndarray:
        """Static displacements (d,) per unit of the driven one, for bonds of `weight` (3 b,) [m].

        ArithmeticError where no solution is found.
        """
        # on the factors of other weights, if there are any; should they fail, once more on new ones
        for last in (self._factor is None, True):
            if self._factor is None:
                self._factor = static_factor(self.system, weight)
            iterations, failed = self._solve(weight, self._factor)
            if failed or iterations > self._enough:
                self._factor = None
            if not failed:
                return self._motion.copy()  # the next solution goes on in place
            if last:
                break
        raise ArithmeticError("the static motion was not found")

    def _solve(self, weight: np.ndarray, factor: SuperLU | Multigrid) -> tuple[int, int]:
        """Go on from the last motion: (iterations taken, zero if they were enough)."""
        system, free = self.system, self.system.free

        # by G and not by a matrix: conjugate gradients need products alone, so new weights cost no assembly
        def force(motion: np.ndarray) -> np.ndarray:
            return np.asarray(self._transpose @ (weight * (system.operator @ motion)))

        def force_on_free(part: np.ndarray) -> np.ndarray:
            whole = np.zeros_like(self._motion)
            whole[free] = part
            return force(whole)[free]

        head = np.zeros_like(self._motion)
        head[system.driven] = 1.0
        taken: list[None] = []
        matrix, near = ((free.size, free.size) for _ in range(2))
        self._motion[free], failed = cg(
            LinearOperator(matrix, force_on_free, dtype=float),
            -force(head)[free],
            x0=self._motion[free],
            rtol=self._tolerance,
            maxiter=self._most,
            M=LinearOperator(near, factor.solve, dtype=float),
            callback=lambda _: taken.append(None),
        )
        return len(taken), failed
