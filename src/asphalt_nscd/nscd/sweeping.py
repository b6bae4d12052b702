"""Plain nonlinear Gauss-Seidel on the bonds: the paper's method, kept for the study of its errors.

Each bond component in turn takes the reaction that satisfies its affine law with all others held,
R = (b - u_rest) / (S/w + dt G_r M^-1 G_r^T), and the velocities are updated at once. For bonds as
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
        rows = system.operator.multiply(system.operator).dot(self._inverse_mass)
        self._diagonal = self.law.compliance / system.weight + dt * rows
        self.sweeps = 0
        self.largest_change = 0.0

    def advance(self, driven_velocity: float) -> float:
        """One step with the driven degree of freedom at driven_velocity [m/s]; the driving force [N]."""
        system, state, dt = self.system, self.state, self.dt
        explicit = self.law.explicit_part(state.sigma, state.kelvin)
        reaction = system.weight * state.sigma
        velocity = state.velocity + dt * self._inverse_mass * (system.load + system.operator.T @ reaction)
        velocity[system.driven] = driven_velocity
        g = system.operator
        sweeps, change = _sweep_until_still(
            g.indptr, g.indices, g.data, self._inverse_mass, self.law.compliance / system.weight,
            self._diagonal, explicit, dt, reaction, velocity, self.tolerance, self.most_sweeps,
        )  # fmt: skip
        self.sweeps += sweeps
        self.largest_change = max(self.largest_change, change)
        inertia = system.mass[system.driven] * (driven_velocity - state.velocity[system.driven]) / dt
        drive = inertia - system.load[system.driven] - (system.operator.T @ reaction)[system.driven]
        sigma = reaction / system.weight
        shape = (-1, 1)
        state.kelvin = self.law.keep.reshape(shape) * state.kelvin - self.law.gain.reshape(shape) * sigma
        state.displacement = state.displacement + dt * velocity
        state.velocity, state.sigma = velocity, sigma
        return float(drive)


@compiled
def _sweep_until_still(
    indptr, indices, data, inverse_mass, law_diagonal, diagonal, explicit, dt, reaction, velocity,
    tolerance, most_sweeps,
):  # fmt: skip
    change = 0.0
    rows = reaction.shape[0]
    for sweep in range(most_sweeps):
        changed = size = 0.0
        for n in range(rows):
            r = n if sweep % 2 == 0 else rows - 1 - n
            opening = 0.0
            for e in range(indptr[r], indptr[r + 1]):
                opening += data[e] * velocity[indices[e]]
            delta = (explicit[r] - opening - law_diagonal[r] * reaction[r]) / diagonal[r]
            reaction[r] += delta
            for e in range(indptr[r], indptr[r + 1]):
                velocity[indices[e]] += dt * inverse_mass[indices[e]] * data[e] * delta
            changed += delta * delta
            size += reaction[r] * reaction[r]
        change = np.sqrt(changed / size) if size > 0.0 else 0.0
        if change < tolerance:
            return sweep + 1, change
    return most_sweeps, change
