"""Full time stepping with the bonds condensed: one symmetric positive definite system per step.

Putting sigma+ = (b - G v+)/S into the equations of motion gives

    (M + dt/S K) v+ = M v- + dt f + dt/S G^T w b

whose matrix is constant while no bond breaks. Broken bonds whose gap closes are frictional
contacts, solved by Gauss-Seidel on their Delassus operator.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from asphalt_nscd.nscd.bonds import BondedSystem
from asphalt_nscd.nscd.friction import solve_contacts
from asphalt_nscd.nscd.law import BondLaw

CLOSED = 1e-12  # m, by which a gap in contact may differ from zero


def factorise(matrix: sparse.csc_matrix):
    """Factors of a symmetric positive definite matrix; `.solve` takes one or many columns."""
    return splu(
        matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


@dataclass
class CondensedState:
    """Motion and bond history at one instant; all zero at rest."""

    displacement: np.ndarray  # (d,) m or rad
    velocity: np.ndarray  # (d,)
    sigma: np.ndarray  # (3 b,) Pa
    kelvin: np.ndarray  # (k, 3 b) m
    broken: list[int] = field(default_factory=list)  # bonds, in the order in which they broke

    @classmethod
    def at_rest(cls, system: BondedSystem, law: BondLaw) -> CondensedState:
        """No motion, no stress."""
        d, rows = system.mass.size, system.weight.size
        kelvin = np.zeros((np.size(law.kelvin_springs), rows))
        return cls(np.zeros(d), np.zeros(d), np.zeros(rows), kelvin)


class ShiftedOperator:
    """M + scale K on the free degrees of freedom, solvable while bonds break.

    Factorised once. Each bond that breaks takes away three rank-one terms, which the Woodbury
    identity accounts for at the cost of three more solves; after many, it is factorised again.
    """

    most_updates = 60  # breakages after which a new factorisation is cheaper

    def __init__(self, system: BondedSystem, scale: float) -> None:
        self._system, self._scale = system, scale
        self._broken: list[int] = []
        self._factorise()

    def remove(self, broken: list[int]) -> None:
        """Make `broken`, which may only grow, the bonds that are absent."""
        new = broken[len(self._broken) :]
        if not new:
            return
        self._broken = list(broken)
        if len(broken) - self._factored > self.most_updates:
            self._factorise()
            return
        rows = (3 * np.asarray(new)[:, None] + np.arange(3)).ravel()
        taken = self._system.operator[rows][:, self._system.free].toarray().T
        self._taken = np.column_stack([self._taken, taken])
        self._response = np.column_stack([self._response, self._factor.solve(taken)])
        self._strength = np.append(self._strength, self._scale * self.weight[rows])
        self.weight[rows] = 0.0
        self._capacitance = np.linalg.inv(np.diag(1.0 / self._strength) - self._taken.T @ self._response)

    def solve(self, force: np.ndarray) -> np.ndarray:
        """Solution for one force (f,) or several (f, columns)."""
        solution = self._solve_once(force)
        if self._strength.size:  # the update cancels digits where bodies become nearly loose
            taken = (self._taken * self._strength) @ (self._taken.T @ solution)
            solution += self._solve_once(force - self._matrix @ solution + taken)
        return solution

    def _solve_once(self, force: np.ndarray) -> np.ndarray:
        solution = self._factor.solve(force)
        if self._strength.size:
            solution += self._response @ (self._capacitance @ (self._taken.T @ solution))
        return solution

    def _factorise(self) -> None:
        system = self._system
        self.weight = system.weight.copy()
        for bond in self._broken:
            self.weight[3 * bond : 3 * bond + 3] = 0.0
        matrix = (sparse.diags_array(system.mass) + self._scale * system.stiffness(self.weight)).tocsc()
        self._matrix = matrix[system.free][:, system.free]
        self._factor, self._factored = factorise(self._matrix), len(self._broken)
        self._taken = self._response = np.empty((system.free.size, 0))
        self._strength, self._capacitance = np.empty(0), np.empty((0, 0))


class CondensedStepper:
    """Steps the full system at constant dt and law; breaks bonds and meets contacts on the way.

    Of the last step: `missing` (d,) [N, N m], what the equations of motion lack, which is the driving
    force where the motion is driven and rounding elsewhere; `utilisation`, the largest of a bond.
    """

    def __init__(self, system: BondedSystem, law: BondLaw, dt: float, state: CondensedState) -> None:
        self.system, self.step_law, self.dt, self.state = system, law.step(dt), dt, state
        self._operator = ShiftedOperator(system, dt / self.step_law.compliance)
        self._operator.remove(state.broken)

    def advance(self, driven_velocity: float) -> float:
        """One step with the driven degree of freedom moving at driven_velocity [m/s].

        Returns the driving force [N]. Bonds that yield break one after another, the most
        overstressed first, and the step is solved again until none is left.
        """
        system, state, dt, law = self.system, self.state, self.dt, self.step_law
        explicit = law.explicit_part(state.sigma, state.kelvin)
        while True:
            velocity, contact_force = self._solve(explicit, driven_velocity)
            sigma, kelvin = law.update(explicit, system.operator @ velocity, state.kelvin)
            utilisation = system.utilisation(self._operator.weight * sigma)
            worst = int(np.argmax(utilisation))
            if utilisation[worst] <= 1.0:
                break
            state.broken.append(worst)
            self._operator.remove(state.broken)
        inertia = system.mass * (velocity - state.velocity) / dt
        reaction = system.operator.T @ (self._operator.weight * sigma)
        self.missing = inertia - system.load - reaction - contact_force
        self.utilisation = float(utilisation[worst])
        state.displacement = state.displacement + dt * velocity
        state.velocity, state.sigma, state.kelvin = velocity, sigma, kelvin
        return float(self.missing[system.driven])

    def _solve(self, explicit: np.ndarray, driven_velocity: float) -> tuple[np.ndarray, np.ndarray]:
        system, state, dt = self.system, self.state, self.dt
        scale = dt / self.step_law.compliance
        impulse = system.mass * state.velocity + dt * system.load
        impulse += scale * (system.operator.T @ (self._operator.weight * explicit))
        opening = system.operator[:, [system.driven]].toarray()[:, 0] * driven_velocity
        impulse -= scale * (system.operator.T @ (self._operator.weight * opening))
        velocity = np.empty_like(impulse)
        velocity[system.driven] = driven_velocity
        free = system.free
        velocity[free] = self._operator.solve(impulse[free])
        return self._meet_contacts(velocity)

    def _meet_contacts(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Correct the velocity by the impulses of all gaps that would close within the step."""
        system, dt = self.system, self.dt
        opening_rows = system.operator[::3]
        gap = system.gap + opening_rows @ self.state.displacement
        closing = np.flatnonzero(gap + dt * (opening_rows @ velocity) < 0.0)
        touching: list[int] = []
        force = np.zeros_like(velocity)
        corrected = velocity
        while not np.isin(closing, touching).all():
            touching = sorted({*touching, *closing.tolist()})
            rows = (3 * np.asarray(touching)[:, None] + np.arange(3)).ravel()
            normal = system.operator[rows]
            response = self._operator.solve(normal[:, system.free].T.toarray())
            delassus = normal[:, system.free] @ response
            free_velocity = normal @ velocity
            free_velocity[::3] += np.maximum(gap[touching], 0.0) / dt
            impulse = solve_contacts(delassus, free_velocity, system.friction)
            corrected = velocity.copy()
            corrected[system.free] += response @ impulse
            force = normal.T @ impulse / dt
            closing = np.flatnonzero(gap + dt * (opening_rows @ corrected) < -CLOSED)
        return corrected, force
