"""Proximal points: a problem softened by a little damping at each contact, solved again and again.

With W + d/rho in place of W and q - d/rho r, which has its solution where r does not change any more,
sweeps and Newton's method see a problem that is far from singular; d falls while they succeed. Slow,
but it gets through rough, tightly held piles on which every interior path ends.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse

from asphalt_nscd.nscd.contacts.newton import refine
from asphalt_nscd.nscd.contacts.problem import ContactProblem

FIRST, LEAST, LARGEST = 0.3, 1e-6, 10.0  # damping d, of the mean of the eigenvalues of W_aa
EASED, STIFFENED = 0.5, 2.0  # factor on d after a point that was reached, after one that was not
NEAR = 1e-2  # each point is solved to this share of the error of the last
MOST_SWEEPS = 500  # for each point
PATIENCE = 60  # points that may pass without the error falling to a half: there may be no solution
HOPEFUL = 1e-2  # error from which Newton's method is tried on the problem itself


def proximal_points(
    problem: ContactProblem, r: np.ndarray, tolerance: float, most_points: int
) -> tuple[np.ndarray, int, int]:
    """Solve the problem repeatedly with a little damping, which falls, until both errors are within tolerance.

    Returns the reactions (3 c,) of the least error [N s] and the numbers of sweeps and of Newton steps.
    """
    best, least = r, max(problem.errors(r))
    error, damping, sweeps, steps = least, FIRST, 0, 0
    mark, mark_point = least, 0
    for point in range(most_points):
        if least < 0.5 * mark:
            mark, mark_point = least, point
        if least <= tolerance or point - mark_point > PATIENCE:
            break
        soft = softened(problem, damping, r)
        # a point far from the solution need not be exact: it only says where the next one is
        aim = max(0.1 * tolerance, NEAR * error)
        r, swept = soft.sweeps(aim, MOST_SWEEPS, r)
        left = max(soft.errors(r))
        if left > aim:
            trial, taken = refine(soft, r, aim)
            steps += taken
            if max(soft.errors(trial)) < left:
                r, left = trial, max(soft.errors(trial))
        sweeps, error = sweeps + swept, max(problem.errors(r))
        candidates = [r]
        if tolerance < error < HOPEFUL:
            trial, taken = refine(problem, r, tolerance)
            steps += taken
            candidates.append(trial)
        for candidate in candidates:
            if max(problem.errors(candidate)) < least:
                best, least = candidate, max(problem.errors(candidate))
        # as a trust region: less damping goes farther at once, more makes each point easier
        damping = max(EASED * damping, LEAST) if left <= aim else min(STIFFENED * damping, LARGEST)
    return best, sweeps, steps


def softened(problem: ContactProblem, damping: float, r: np.ndarray) -> ContactProblem:
    """The problem with `damping` / rho on the diagonal of W and what that does to `r` (3 c,) [N s] taken off q."""
    added = damping / problem.length
    block = problem.block.copy()
    block[problem.own] += added[:, None, None] * np.eye(3)
    each = np.repeat(added, 3)
    return replace(
        problem,
        block=block,
        matrix=sparse.csr_array(problem.matrix + sparse.diags_array(each)),
        free_velocity=problem.free_velocity - each * r,
    )
