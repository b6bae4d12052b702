"""Signorini-Coulomb contacts coupled through a Delassus operator: the solver for all of them.

Sweeps are cheap and end most problems. Those on which they stall are led to a solution along an
interior path, with Newton's method trying to finish whenever the error has fallen to a tenth; where
all paths end, proximal points go on.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from asphalt_nscd.nscd.contacts.interior import interior_path
from asphalt_nscd.nscd.contacts.newton import refine
from asphalt_nscd.nscd.contacts.problem import AnyMatrix, ContactProblem
from asphalt_nscd.nscd.contacts.proximal import proximal_points

# Start and balance of the paths, tried in turn: no single choice leads through every rock pile
PATHS = ((3.0, 0.0), (10.0, 0.3), (10.0, 1.0), (100.0, 0.3), (1000.0, 0.0))

FINEST = 1e-14  # tolerance: rounding keeps most problems from smaller errors, and all methods would be tried in vain
FIRST_REFINEMENT = 1e-3  # error from which Newton's method may see the right statuses
AGAIN = 10  # steps of a path after which Newton's method tries anew
PATIENCE = 60  # steps of a path that may pass without the error falling to a half


@dataclass(frozen=True)
class ContactSolution:
    """Reactions with their errors; only where `converged`, both within the tolerance, are they a solution.

    `reactions` r (3 c,) in N s, `velocities` u = W r + q (3 c,) in m/s. `error` is the natural map in the given units,
    comparable with Siconos's, `scaled_error` that free of units (`natural_map`). `sweeps` are of Gauss-Seidel, `steps`
    of the interior path and of Newton's method: one factorisation each, or more.
    """

    reactions: np.ndarray
    velocities: np.ndarray
    error: float
    scaled_error: float
    sweeps: int
    steps: int
    converged: bool

    @property
    def iterations(self) -> int:
        """Number of sweeps and steps together."""
        return self.sweeps + self.steps

    def require_converged(self) -> ContactSolution:
        """Give the solution itself; ArithmeticError, which says how far it is from one, if not converged."""
        if not self.converged:
            worst = max(self.error, self.scaled_error)
            raise ArithmeticError(
                f"contacts not solved: error {worst:.1e} after {self.iterations} iterations"
            )
        return self


def solve_contacts(
    W: AnyMatrix,
    q: ArrayLike,
    mu: ArrayLike,
    tolerance: float = 1e-8,
    most_sweeps: int = 3000,
    most_steps: int = 200,
) -> ContactSolution:
    """Reactions r with u = W r + q, opening u_n >= 0, r_n >= 0, complementary, and Coulomb friction.

    `W` (3 c, 3 c) [1/kg] is positive semidefinite, of any storage; free velocities `q` (3 c,) [m/s] come normal first;
    `mu` is one for all contacts or (c,). The error is that of `natural_map`, relative to the whole of what W couples;
    it is for the caller to look at `converged`. Where W is indefinite there may be no solution, or several.
    `most_steps` bounds each interior path; there may be twice as many proximal points.

    >>> W, q = np.eye(3) / 2.0, [-9.81e-3, 2e-3, 0.0]
    >>> solve_contacts(W, q, mu=0.5).reactions.round(12).tolist()  # stops it
    [0.01962, -0.004, 0.0]
    >>> solve_contacts(W, q, mu=0.1).reactions.round(12).tolist()  # slows it down
    [0.01962, -0.001962, 0.0]
    """
    if not FINEST <= tolerance < 1.0:
        raise ValueError(f"tolerance {tolerance} is not between {FINEST:g}, near rounding, and 1")
    q = np.array(q, float).ravel()
    if np.shape(W) == (0, 0) and not q.size:
        return ContactSolution(q, q, 0.0, 0.0, 0, 0, True)
    # a power of two changes no digit, and leaves room for squares
    exponent = int(np.frexp(np.abs(q).max(initial=0.0))[1]) if np.isfinite(q).all() else 0
    problem = ContactProblem.of(W, np.ldexp(q, -exponent), mu)
    best, sweeps = problem.sweeps(tolerance, most_sweeps, np.zeros_like(q))
    least, steps = max(problem.errors(best)), 0
    for start, balance in PATHS:
        if least <= tolerance:
            break
        with np.errstate(all="ignore"):  # a path without an end ends there
            path = interior_path(problem, start, balance)
            found, error, taken = _follow(problem, path, tolerance, most_steps)
        steps += taken
        if error < least:
            best, least = found, error
    if least > tolerance:
        with np.errstate(all="ignore"):
            best, swept, taken = proximal_points(problem, best, tolerance, 2 * most_steps)
        sweeps, steps, least = sweeps + swept, steps + taken, max(problem.errors(best))
    error, scaled = problem.errors(best)
    with np.errstate(over="ignore"):
        reactions, velocities = np.ldexp(best, exponent), np.ldexp(problem.velocity(best), exponent)
    if not (np.isfinite(reactions).all() and np.isfinite(velocities).all()):
        raise ValueError("reactions are beyond the largest number; give W and q in other units")
    return ContactSolution(reactions, velocities, error, scaled, sweeps, steps, bool(least <= tolerance))


def _follow(
    problem: ContactProblem, path: Iterator[np.ndarray], tolerance: float, most_steps: int
) -> tuple[np.ndarray, float, int]:
    """The best reactions along a path and by Newton's method from it, their error, and the steps."""
    best, least, steps = np.zeros_like(problem.free_velocity), np.inf, 0
    # ten times FIRST_REFINEMENT, so that the first trial comes where the error falls below it
    refined, refined_step, mark, mark_step = 10.0 * FIRST_REFINEMENT, 0, np.inf, 0
    for step, r in zip(range(most_steps), path, strict=False):
        error, steps = max(problem.errors(r)), steps + 1
        candidates = [(error, r)]
        # Newton's method costs some steps of the path. It is tried when the error fell to a tenth since the
        # last trial, or after AGAIN steps if it fell at all
        if tolerance < error < 0.1 * refined or (error < refined and step - refined_step >= AGAIN):
            refined, refined_step = error, step
            sharper, r, taken = _sharpened(problem, r, error, tolerance)
            steps += taken
            candidates.append((sharper, r))
        for candidate, reactions in candidates:
            if candidate < least:
                best, least = reactions, candidate
        if least <= tolerance:
            break
        if error < 0.5 * mark:
            mark, mark_step = error, step
        elif step - mark_step > PATIENCE:
            break
    return best, least, steps


def _sharpened(
    problem: ContactProblem, r: np.ndarray, error: float, tolerance: float
) -> tuple[float, np.ndarray, int]:
    """(error, reactions, steps) of Newton's method from r, begun anew as long as it halves the error."""
    steps = 0
    while True:
        trial, taken = refine(problem, r, tolerance)
        found, steps = max(problem.errors(trial)), steps + taken
        if found >= error:
            return error, r, steps
        enough = found <= tolerance or found > 0.5 * error
        r, error = trial, found
        if enough:
            return error, r, steps
