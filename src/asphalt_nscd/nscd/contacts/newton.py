"""Semismooth Newton method on the natural map F(r) = r - P_K(r - rho (u + mu |u_T| n)).

Local: it sharpens reactions whose contacts are almost rightly told apart into open, sticking and
slipping. Proximal terms that shrink with F keep the Jacobian regular where W is not.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.contacts.coulomb import projections
from asphalt_nscd.nscd.contacts.problem import ContactProblem


def refine(
    problem: ContactProblem, r: np.ndarray, tolerance: float, most_steps: int = 12
) -> tuple[np.ndarray, int]:
    """Reactions (3 c,) [N s] after Newton steps, each of which reduces |F|, and the number of steps.

    Steps end when both errors are below `tolerance` or progress is slow.
    """
    weight = np.repeat(1.0 / np.sqrt(problem.length), 3)
    scale = max(
        np.linalg.norm(weight * r), np.linalg.norm(problem.free_velocity / weight), np.finfo(float).tiny
    )
    residual, by_reaction, by_velocity = linearised(problem, r)
    norm = first_norm = np.linalg.norm(weight * residual)
    for step in range(most_steps):
        # Newton's method is quadratic or of no use: a residual that falls to more than 0.7 of itself a step,
        # in the mean, says that statuses are wrong
        if max(problem.errors(r)) <= tolerance or (step > 2 and norm > first_norm * 0.7**step):
            return r, step
        # the damping shrinks with the residual, so that the last steps are those of Newton; a hundredfold is
        # tried where W leaves the Jacobian near singular
        for proximal in min(1e-2, norm / scale) * np.array([1.0, 100.0]):
            direction = _newton_direction(problem, residual, by_reaction, by_velocity, proximal)
            if direction is None:
                continue
            # the map has kinks where statuses change: a full step may cross one and a third of it not.
            shorter = [r + t * direction for t in (1.0, 1 / 3, 1 / 9)]
            trial = next((x for x in shorter if _norm(problem, weight, x) < 0.99 * norm), None)
            if trial is not None:
                break
        else:
            return r, step
        r = trial
        residual, by_reaction, by_velocity = linearised(problem, r)
        norm = np.linalg.norm(weight * residual)
    return r, most_steps


def linearised(problem: ContactProblem, r: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """F (3 c,) at reactions `r` (3 c,) [N s], and D, B (c, 3, 3) of dF = D dr + B du, where du = W dr."""
    mu, rho = problem.friction, problem.length
    u = problem.velocity(r).reshape(-1, 3)
    slip = np.hypot(u[:, 1], u[:, 2])
    z = r.reshape(-1, 3) - rho[:, None] * u
    z[:, 0] -= rho * mu * slip
    point, projection = projections(z, mu)
    # |u_T| has a kink at rest: zero is one of its generalised derivatives
    along = u[:, 1:] / np.where(slip > 0.0, slip, 1.0)[:, None]
    shift = np.tile(np.eye(3), (mu.size, 1, 1))
    shift[:, 0, 1:] = mu[:, None] * along
    by_velocity = rho[:, None, None] * (projection @ shift)
    return r - point.ravel(), np.eye(3) - projection, by_velocity


def _norm(problem: ContactProblem, weight: np.ndarray, r: np.ndarray) -> float:
    return float(np.linalg.norm(weight * linearised(problem, r)[0]))


def _newton_direction(
    problem: ContactProblem,
    residual: np.ndarray,
    by_reaction: np.ndarray,
    by_velocity: np.ndarray,
    proximal: float,
) -> np.ndarray | None:
    """-(D + B (W + proximal / rho))^-1 F, with the open contacts taken out; None if singular."""
    # an open contact has the derivative I by r and none by u: its direction is known, and its rows leave the
    # system
    pressed = np.abs(by_velocity).sum(axis=(1, 2)) > 0.0
    direction = -residual
    if not pressed.any():
        return direction
    closed = np.repeat(pressed, 3)
    jacobian = by_velocity[problem.row] @ problem.block
    jacobian[problem.own] += by_reaction + by_velocity * (proximal / problem.length)[:, None, None]
    factor = problem.factor(jacobian, pressed)
    if factor is None:
        return None
    opened = (problem.matrix @ np.where(closed, 0.0, direction)).reshape(-1, 3)
    right = direction - np.einsum("aij,aj->ai", by_velocity, opened).ravel()
    direction[closed] = factor.solve(right[closed], "T")
    return direction if np.isfinite(direction).all() else None
