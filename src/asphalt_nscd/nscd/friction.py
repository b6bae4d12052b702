"""Signorini-Coulomb contacts coupled through a dense Delassus operator."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled


def solve_contacts(
    delassus: np.ndarray, free_velocity: np.ndarray, friction: float,
    tolerance: float = 1e-12, most_sweeps: int = 100_000,
) -> np.ndarray:  # fmt: skip
    """Impulses r (3 c,) [N s] with u = W r + q, opening u_n >= 0, r_n >= 0, and Coulomb friction.

    delassus W (3 c, 3 c) [1/kg], free_velocity q (3 c,) [m/s], both in contact frames with the
    normal first. The error is that of the natural map, relative to |q|. Raises ArithmeticError
    where it stays above `tolerance`.
    """
    impulse, error = _projected_sweeps(
        np.ascontiguousarray(delassus), free_velocity, friction, tolerance, most_sweeps
    )
    if error > tolerance:
        raise ArithmeticError(f"contacts not solved: error {error:.1e} above {tolerance:.1e}")
    return impulse


@compiled
def _projected_sweeps(w, q, friction, tolerance, most_sweeps):
    """Gauss-Seidel with one projection on the cone per contact; the step length is that of its block."""
    contacts = q.shape[0] // 3
    r = np.zeros(q.shape[0])
    u = q.copy()
    scale = np.sqrt((q * q).sum())
    step = np.empty(contacts)
    for c in range(contacts):
        trace = w[3 * c, 3 * c] + w[3 * c + 1, 3 * c + 1] + w[3 * c + 2, 3 * c + 2]
        step[c] = 1.0 / trace
    error = np.inf
    for _ in range(most_sweeps):
        square = 0.0
        for c in range(contacts):
            k = 3 * c
            slip = np.sqrt(u[k + 1] ** 2 + u[k + 2] ** 2)
            # de Saxce: the shifted velocity turns Coulomb's law into a projection on the cone
            new = _project_on_cone(
                r[k] - step[c] * (u[k] + friction * slip),
                r[k + 1] - step[c] * u[k + 1],
                r[k + 2] - step[c] * u[k + 2],
                friction,
            )
            for d in range(3):
                delta = new[d] - r[k + d]
                if delta != 0.0:
                    square += (delta / step[c]) ** 2
                    r[k + d] = new[d]
                    for m in range(u.shape[0]):
                        u[m] += w[m, k + d] * delta
        error = np.sqrt(square) / scale if scale > 0.0 else 0.0
        if error < tolerance:
            break
    return r, error


@compiled
def _project_on_cone(n, t, s, friction):
    """Nearest point of the cone |(t, s)| <= friction n."""
    tangential = np.sqrt(t * t + s * s)
    if tangential <= friction * n:
        return n, t, s
    if friction * tangential <= -n:
        return 0.0, 0.0, 0.0
    height = (n + friction * tangential) / (1.0 + friction * friction)
    scale = friction * height / tangential if tangential > 0.0 else 0.0
    return height, scale * t, scale * s
