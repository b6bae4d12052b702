"""Full time stepping with compliant contacts beside the films, instead of rigid ones where gaps close.

A step of the films is (M + dt G^T w/S G) v = b, a matrix. Reactions R of contacts at the openings H (u + dt v) add
dt H^T R to its right side. It is solved by Newton's method with the tangent of an earlier step, accelerated by
Anderson's mixing; a new tangent is factorised where that takes too long.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.optimize import NoConvergence, anderson

from asphalt_nscd.nscd.bonds.implicit_operator import factorise
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.skeleton import Grip, Skeleton

MEMORY = 6  # of Anderson's mixing
MOST_ITERATIONS = 30
MOST_TANGENTS = 4  # in a step, before it is given up


class CompliantStepper(CondensedStepper):
    """Steps films and contacts at constant dt [s]; bonds do not break.

    `tolerance` [m]: how far an opening may lie from that in balance. `grip` is that at the end of the last step;
    `contact` as in `CondensedStepper`, all of them.
    """

    def __init__(
        self,
        system: BondedSystem,
        law: AnyLaw,
        dt: float,
        state: CondensedState,
        skeleton: Skeleton,
        tolerance: float,
    ) -> None:
        # a bond that broke would stay in the matrices below
        system = replace(system, strength=np.full_like(system.strength, np.inf))
        super().__init__(system, law, dt, state)
        self.skeleton, self.tolerance, self.grip = skeleton, tolerance, Grip.rest(skeleton)
        self._rows = system.operator[skeleton.rows].tocsr()
        self._free = self._rows[:, system.free].tocsr()
        scale = dt / self.step_law.compliance
        films = sparse.diags_array(system.mass) + system.stiffness(scale * system.weight)
        self._films = films.tocsr()[system.free][:, system.free].tocsr()
        self._factorise(self.grip)

    def advance(self, driven_velocity: float) -> float:
        """As in `CondensedStepper`; contacts go on from the grip at the end of the step."""
        force = super().advance(driven_velocity)
        self.grip = self._next
        return force

    def _factorise(self, grip: Grip) -> None:
        """Factorise the tangent at a grip, its contacts stuck."""
        own = self.skeleton.stiffness(self.skeleton.overlap - grip.opening[:, 0])
        contacts = self._free.T @ sparse.diags_array(self.dt**2 * own) @ self._free
        self._tangent = factorise((self._films + contacts).tocsc(), self.system)

    def _meet_contacts(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(velocity (d,), force (d,) [N] of contacts) in balance, from the velocity of films alone."""
        free, dt = self.system.free, self.dt
        alone = velocity[free]
        # openings at the end of the step if nothing but the head moved; what the rest moves is added below
        start = self._rows @ (self.state.displacement + dt * velocity) - dt * (self._free @ alone)

        def missing(moving: np.ndarray) -> np.ndarray:
            """Newton's step (f,), sign reversed, at velocities (f,) that are not in balance: about their error."""
            reaction, _ = self.grip.moved(self.skeleton, start + dt * (self._free @ moving))
            return np.asarray(
                self._tangent.solve(self._films @ (moving - alone) - dt * (self._free.T @ reaction))
            )

        def size(error: np.ndarray) -> float:
            """Largest error of an opening [m]."""
            return dt * float(np.abs(self._free @ error).max())

        moving = self.state.velocity[free]
        for _ in range(MOST_TANGENTS):
            try:
                moving = anderson(
                    missing,
                    moving,
                    alpha=-1.0,
                    M=MEMORY,
                    maxiter=MOST_ITERATIONS,
                    f_tol=self.tolerance,
                    tol_norm=size,
                    line_search=None,
                )
                break
            except NoConvergence as stopped:
                moving = stopped.args[0]
                self._factorise(self.grip.moved(self.skeleton, start + dt * (self._free @ moving))[1])
        else:
            raise ArithmeticError("contacts of a step find no balance")
        corrected = velocity.copy()
        corrected[free] = moving
        reaction, self._next = self.grip.moved(self.skeleton, start + dt * (self._free @ moving))
        self.contact = reaction, self._rows @ corrected
        return corrected, self._rows.T @ reaction
