"""Openings and reactions of bonds from rigid-body kinematics, one bond at a time."""

from __future__ import annotations

import numpy as np


def naive_openings(first, second, frame, point, position, velocity):
    """(b, 3) opening velocities in the bonds' frames; velocity (n, 6); bodies from n on stand still."""
    openings = np.empty((len(first), 3))
    for b, (i, j) in enumerate(zip(first, second)):
        at_point = [
            velocity[k, :3] + np.cross(velocity[k, 3:], point[b] - position[k])
            if k < len(position)
            else np.zeros(3)
            for k in (i, j)
        ]
        openings[b] = frame[b] @ (at_point[1] - at_point[0])
    return openings


def naive_forces(first, second, frame, point, position, reaction):
    """(n, 6) forces and torques of reactions (b, 3) that act on the second bodies."""
    forces = np.zeros((len(position), 6))
    for b, (i, j) in enumerate(zip(first, second)):
        force = frame[b].T @ reaction[b]
        for body, sign in ((i, -1.0), (j, 1.0)):
            if body < len(position):
                arm = point[b] - position[body]
                forces[body] += sign * np.concatenate([force, np.cross(arm, force)])
    return forces


def naive_bond_sweeps(
    operator,
    weight,
    mass,
    driven,
    compliance,
    explicit,
    reaction,
    velocity,
    dt,
    tolerance,
    most_sweeps,
    visits,
):
    """Gauss-Seidel bond by bond on dense rows: (reaction, velocity, sweeps, last change). Bond law U = b - (S/w) R.

    visits (b,): the bonds in the order of a sweep forth.
    """
    rows = operator.toarray()
    inverse = 1.0 / mass
    inverse[driven] = 0.0
    reaction, velocity = reaction.copy(), velocity.copy()
    for sweep in range(most_sweeps):
        changed = size = 0.0
        for bond in visits if sweep % 2 == 0 else reversed(visits):
            own = slice(3 * bond, 3 * bond + 3)
            g = rows[own]
            law = np.diag(compliance / weight[own])
            rest = g @ (velocity - dt * inverse * (g.T @ reaction[own]))  # opening without this bond
            new = np.linalg.solve(law + dt * (g * inverse) @ g.T, explicit[own] - rest)
            delta = new - reaction[own]
            velocity += dt * inverse * (g.T @ delta)
            reaction[own] = new
            changed, size = changed + delta @ delta, size + new @ new
        change = np.sqrt(changed / size)
        if change < tolerance:
            break
    return reaction, velocity, sweep + 1, change
