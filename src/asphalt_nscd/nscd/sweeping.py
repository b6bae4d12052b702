"""Plain nonlinear Gauss-Seidel on the bonds: the paper's method, kept for the study of its errors.

Each bond in turn takes the reaction that satisfies its affine law with all others held: three
equations (S/w + dt G_b M^-1 G_b^T) R = b - u_rest. Velocities are updated at once. For bonds as
stiff as these (dt^2 K/m of a thousand and more) the change per sweep is small long before the
solution is reached, so a criterion on that change stops far from it.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.bonds import BondedSystem
from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.condensed import CondensedState
from asphalt_nscd.nscd.law import BondLaw


class SweepingStepper:
    """Steps the full system by Gauss-Seidel; bonds do not break and gaps are not watched."""

    def __init__(
        self, system: BondedSystem, law: BondLaw, dt: float, state: CondensedState,
        tolerance: float, most_sweeps: int,
    ) -> None:  # fmt: skip
        self.system, self.law, self.dt, self.state = system, law.step(dt), dt, state
        self.tolerance, self.most_sweeps = tolerance, most_sweeps
        self._inverse_mass = 1.0 / system.mass
        self._inverse_mass[system.driven] = 0.0
        self._law_diagonal = self.law.compliance / system.weight
        self._column = system.operator[:, [system.driven]]
        self._inverse_block = self._local_inverses()
        self.sweeps = 0
        self.largest_change = 0.0

    def advance(self, driven_velocity: float) -> float:
        """One step with the driven degree of freedom at driven_velocity [m/s]; the driving force [N]."""
        system, state, dt = self.system, self.state, self.dt
        explicit = self.law.explicit_part(state.sigma, state.kelvin)
        reaction = system.weight * state.sigma
        velocity = state.velocity + dt * self._inverse_mass * (system.load + system.operator.T @ reaction)
        velocity[system.driven] = driven_velocity
        sweeps, change = _sweep_until_still(
            system.operator.indptr, system.operator.indices, system.operator.data, dt * self._inverse_mass,
            self._law_diagonal, self._inverse_block, explicit, reaction, velocity, self.tolerance,
            self.most_sweeps,
        )  # fmt: skip
        self.sweeps += sweeps
        self.largest_change = max(self.largest_change, change)
        inertia = system.mass[system.driven] * (driven_velocity - state.velocity[system.driven]) / dt
        drive = inertia - system.load[system.driven] - (self._column.T @ reaction)[0]
        sigma = reaction / system.weight
        shape = (-1, 1)
        state.kelvin = self.law.keep.reshape(shape) * state.kelvin - self.law.gain.reshape(shape) * sigma
        state.displacement = state.displacement + dt * velocity
        state.velocity, state.sigma = velocity, sigma
        return float(drive)

    def _local_inverses(self) -> np.ndarray:
        """(S/w + dt G_b M^-1 G_b^T)^-1 of every bond, (b, 3, 3)."""
        operator = self.system.operator
        bonds = operator.shape[0] // 3
        block = np.zeros((bonds, 3, 3))
        for c in range(3):
            for d in range(3):
                product = operator[c::3].multiply(operator[d::3])
                block[:, c, d] = self.dt * (product @ self._inverse_mass)
            block[:, c, c] += self._law_diagonal[c::3]
        return np.linalg.inv(block)


@compiled
def _sweep_until_still(
    indptr, indices, data, mobility, law_diagonal, inverse_block, explicit, reaction, velocity,
    tolerance, most_sweeps,
):  # fmt: skip
    """Sweeps to and fro over the bonds until the relative change of the reactions is below tolerance.

    The three rows of a bond act on the same degrees of freedom. mobility = dt M^-1.
    Returns (sweeps, relative change of the last sweep).
    """
    change = 0.0
    bonds = inverse_block.shape[0]
    miss = np.empty(3)
    delta = np.empty(3)
    for sweep in range(most_sweeps):
        changed = size = 0.0
        for n in range(bonds):
            bond = n if sweep % 2 == 0 else bonds - 1 - n
            first = 3 * bond
            begin = indptr[first]
            touched = indptr[first + 1] - begin
            for c in range(3):
                miss[c] = explicit[first + c] - law_diagonal[first + c] * reaction[first + c]
            for e in range(touched):
                v = velocity[indices[begin + e]]
                for c in range(3):
                    miss[c] -= data[begin + c * touched + e] * v
            for c in range(3):
                delta[c] = 0.0
                for d in range(3):
                    delta[c] += inverse_block[bond, c, d] * miss[d]
                reaction[first + c] += delta[c]
                changed += delta[c] * delta[c]
                size += reaction[first + c] * reaction[first + c]
            for e in range(touched):
                k = indices[begin + e]
                push = 0.0
                for c in range(3):
                    push += data[begin + c * touched + e] * delta[c]
                velocity[k] += mobility[k] * push
        change = np.sqrt(changed / size) if size > 0.0 else 0.0
        if change < tolerance:
            return sweep + 1, change
    return most_sweeps, change
