"""One implicit Euler step of a bonded system as one dense set of equations, nothing condensed.

Unknowns are the free velocities and the bond stresses together; in the Galerkin form the velocities
are those of a basis. The rheology is that of one spring, one dashpot and Kelvin elements in series.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem


@dataclass
class NaiveState:
    displacement: np.ndarray
    velocity: np.ndarray
    sigma: np.ndarray
    memory: np.ndarray  # of Kelvin elements
    residual: float = 0.0  # of the full equations of the last step, see naive_step

    @classmethod
    def at_rest(cls, system: BondedSystem, law: BondLaw) -> NaiveState:
        d, rows = system.mass.size, system.weight.size
        return cls(np.zeros(d), np.zeros(d), np.zeros(rows), np.zeros((len(law.kelvin_springs), rows)))


def naive_step(
    system: BondedSystem,
    law: BondLaw,
    dt: float,
    state: NaiveState,
    driven_velocity: float,
    broken=(),
    basis: np.ndarray | None = None,
) -> tuple[NaiveState, float]:
    """(state, driving force [N]) after dt. basis (d, k): column 0 the driven motion; None for all of them."""
    g, rows = system.operator.toarray(), system.weight.size
    weight = system.weight.copy()
    for bond in broken:
        weight[3 * bond : 3 * bond + 3] = 0.0
    if basis is None:
        basis = np.roll(np.eye(system.mass.size), -system.driven, axis=1)
    known, free = basis[:, 0] * driven_velocity, basis[:, 1:]
    k = free.shape[1]

    # U+ = b - S sigma+, element by element
    compliance, explicit = 1.0 / (dt * law.spring) + 1.0 / law.dashpot, state.sigma / (dt * law.spring)
    for modulus, viscosity, old in zip(law.kelvin_springs, law.kelvin_dashpots, state.memory):
        compliance += 1.0 / (viscosity + dt * modulus)
        explicit = explicit - modulus * old / (viscosity + dt * modulus)
    # Phi^T [M (v+ - v)/dt - f - G^T w sigma+] = 0 and S sigma+ + G v+ = b
    matrix = np.zeros((k + rows, k + rows))
    matrix[:k, :k] = free.T @ (system.mass[:, None] * free) / dt
    matrix[:k, k:] = -(free.T @ g.T) * weight
    matrix[k:, :k] = g @ free
    matrix[k:, k:] = compliance * np.eye(rows)
    inertia = system.mass * (state.velocity - known) / dt
    right = np.concatenate([free.T @ (inertia + system.load), explicit - g @ known])
    scale = 1.0 / np.abs(matrix).max(axis=1)  # rows of forces and of velocities differ by twenty orders
    solution = np.linalg.solve(scale[:, None] * matrix, scale * right)
    velocity, sigma = known + free @ solution[:k], solution[k:]

    kelvin = np.array(
        [
            (viscosity * old - dt * sigma) / (viscosity + dt * modulus)
            for modulus, viscosity, old in zip(law.kelvin_springs, law.kelvin_dashpots, state.memory)
        ]
    ).reshape(state.memory.shape)
    missing = system.mass * (velocity - state.velocity) / dt - system.load - g.T @ (weight * sigma)
    diagonal = ((g**2).T @ system.weight)[system.free]
    residual = float(np.linalg.norm(missing[system.free] / np.sqrt(diagonal)))
    force = float(basis[:, 0] @ missing)
    return NaiveState(state.displacement + dt * velocity, velocity, sigma, kelvin, residual), force
