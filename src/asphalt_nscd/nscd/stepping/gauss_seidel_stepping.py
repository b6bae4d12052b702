"""Plain nonlinear Gauss-Seidel on the bonds: the paper's method, kept for the study of its errors.

Each bond in turn takes the reaction that satisfies its affine law with all others held: three
equations (S/w + dt G_b M^-1 G_b^T) R = b - u_rest. Velocities are updated at once. For bonds as
stiff as these (dt^2 K/m of a thousand and more) the change per sweep is small long before the
solution is reached, so a criterion on that change stops far from it.
In double precision: single takes 0.8 of the time, and its rounding changed |E*| by up to 0.7 % at a change of 1e-5.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.bonds.gauss_seidel import PackedBonds
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState


class SweepingStepper:
    """Steps the full system by Gauss-Seidel, `dt` in s; bonds do not break and gaps are not watched."""

    def __init__(
        self,
        system: BondedSystem,
        law: AnyLaw,
        dt: float,
        state: CondensedState,
        tolerance: float,
        most_sweeps: int,
    ) -> None:
        self.system, self.law, self.dt, self.state = system, law.step(dt), dt, state
        self.tolerance, self.most_sweeps = tolerance, most_sweeps
        self._inverse_mass = 1.0 / system.mass
        self._inverse_mass[system.driven] = 0.0  # no reaction moves what is driven
        self._column = system.operator[:, [system.driven]]
        self._bonds = PackedBonds(
            system.operator, dt * self._inverse_mass, self.law.compliance / system.weight
        )
        self.sweeps = 0
        self.largest_change = 0.0

    @property
    def visits(self) -> np.ndarray:
        """The bonds (b,) in the order of a sweep forth; the next one goes back."""
        return self._bonds.visits

    def move(self, start: float, end: float) -> float:
        """Driving force [N] in one step, in which the head moves from `start` to `end` [m]."""
        return self.advance((end - start) / self.dt)

    def advance(self, driven_velocity: float) -> float:
        """Driving force [N] in one step at this velocity of the driven degree of freedom [m/s]."""
        system, state, dt = self.system, self.state, self.dt
        explicit = self.law.explicit_part(state.sigma, state.memory)
        reaction = system.weight * state.sigma
        velocity = state.velocity + dt * self._inverse_mass * system.load
        velocity[system.driven] = driven_velocity
        reaction, velocity, sweeps, change = self._bonds.sweep_until_still(
            explicit, reaction, velocity, self.tolerance, self.most_sweeps
        )
        if not np.isfinite(velocity).all():
            raise ArithmeticError("the motion of a step is not finite")
        self.sweeps += sweeps
        self.largest_change = max(self.largest_change, change)
        inertia = system.mass[system.driven] * (driven_velocity - state.velocity[system.driven]) / dt
        # by the head's own equation of motion: it holds, whatever the sweeps have left open elsewhere
        drive = inertia - system.load[system.driven] - (self._column.T @ reaction)[0]
        sigma = reaction / system.weight
        opening = (
            explicit - self.law.compliance * sigma
        )  # by the law, which the sweeps leave open at the bodies
        state.memory = self.law.remembered(sigma, opening, state.memory)
        state.displacement = state.displacement + dt * velocity
        state.velocity, state.sigma = velocity, sigma
        return float(drive)
