"""Contacts that bear a couple beside their force: it resists turning, by no more than an arm times the normal force."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.contacts.friction import solve_contacts

MOST_ROUNDS = 1000  # where all couples follow or stay, two are enough


def solve_with_couples(
    W: np.ndarray, q: np.ndarray, mu: np.ndarray, arm: np.ndarray, tolerance: float
) -> np.ndarray:
    """Impulses (6 c,): forces of all contacts [N s], as of `solve_contacts`, then their couples [N m s].

    `W` (6 c, 6 c) and `q` (6 c,) hold openings, normal first, and then angular velocities, for which couples m are

        |m| <= arm r_n,    m opposite to the angular velocity where they reach it, none where they do not.

    Forces and couples are solved in turn: forces with couples that prevent turning where these are below their limit,
    and keep their value where they are at it. ArithmeticError where they do not settle.
    """
    split, couples, following = 3 * mu.size, np.zeros(3 * mu.size), np.ones(3 * mu.size, bool)
    crossed, among, own = W[:split, split:], W[split:, split:], np.arange(split).reshape(-1, 3)
    # a sphere turns as easily about any axis: one number is then its block
    ease = [np.linalg.norm(among[np.ix_(rows, rows)], 2) for rows in own]
    for _ in range(MOST_ROUNDS):
        held = np.where(following, 0.0, couples)
        # a sphere between walls has more couples than ways to turn: the matrix is then singular
        back = crossed[:, following] @ np.linalg.pinv(among[np.ix_(following, following)], hermitian=True)
        under = q[:split] + crossed @ held - back @ (q[split:] + among @ held)[following]
        softer = W[:split, :split] - back @ crossed[:, following].T
        solved = solve_contacts(0.5 * (softer + softer.T), under, mu, tolerance=tolerance)
        forces = solved.require_converged().reactions
        free, last, limits = q[split:] + forces @ crossed, couples, arm * forces[::3]
        for _ in range(MOST_ROUNDS):
            before, couples = couples, couples.copy()
            for rows, turns, limit in zip(own, ease, limits, strict=True):
                pushed = couples[rows] - (free[rows] + among[rows] @ couples) / turns
                couples[rows] = pushed * min(1.0, limit / max(float(np.linalg.norm(pushed)), 1e-300))
            if np.abs(couples - before).max() <= tolerance * np.abs(couples).max():
                break
        if np.abs(couples - last).max() <= tolerance * np.abs(couples).max():
            return np.concatenate([forces, couples])
        following = np.repeat(np.linalg.norm(couples[own], axis=1) < (1.0 - 1e-9) * limits, 3)
    raise ArithmeticError("couples of contacts do not settle")
