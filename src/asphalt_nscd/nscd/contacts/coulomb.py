"""Coulomb's law beside Signorini's condition, for one contact. All solvers of contacts take it from here.

A reaction lies in the cone |(t, s)| <= mu n. A contact that slips does so against its tangential reaction.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled, compiled_for_teams
from asphalt_nscd.nscd.lanes import broadcast, select_greater, sqrt


@compiled_for_teams
def cut(x, y, z, limit):
    """Cut tangential reactions of eight contacts to Coulomb's `limit`, mu times the normal reactions."""
    square = x * x + y * y + z * z
    # all lanes compute both values: that of a contact without tangential force, 0/0, is never taken
    share = select_greater(square, limit * limit, limit / sqrt(square), broadcast(1.0))
    return share * x, share * y, share * z


@compiled
def one_contact(w, q0, q1, q2, mu):
    """Reaction [N s] of one contact, r_n and both parts of r_T; `w` (3, 3) is its full block of W [1/kg].

    Slip means r_T = -u_T / s with s > 0. With r_n eliminated by u_n = 0 there remains (A + s) r_T = -g, and s follows
    from |r_T| = mu r_n: Newton's method on the difference of the reciprocals, kept within bounds. s = 0 is sticking.
    `q0, q1, q2` is the free velocity [m/s], normal first.
    """
    # where nothing can move no reaction helps, and the natural map tells that there is no solution
    if q0 >= 0.0 or w[0, 0] <= 0.0:
        return 0.0, 0.0, 0.0
    stopping = -q0 / w[0, 0]
    # below, the reciprocal of mu r_n is taken
    if mu == 0.0:
        return stopping, 0.0, 0.0
    b1, b2 = w[0, 1] / w[0, 0], w[0, 2] / w[0, 0]
    a11, a12 = w[1, 1] - w[1, 0] * b1, w[1, 2] - w[1, 0] * b2
    a21, a22 = w[2, 1] - w[2, 0] * b1, w[2, 2] - w[2, 0] * b2
    g1, g2 = q1 + w[1, 0] * stopping, q2 + w[2, 0] * stopping
    # nothing slips, and |r_T| = 0 has no reciprocal either
    if g1 == 0.0 and g2 == 0.0:
        return stopping, 0.0, 0.0
    trace = a11 + a22
    low, high = 0.0, np.inf
    # a block that the other contacts leave singular sticks in one direction only: a trace of s makes it
    # solvable
    s = 0.0 if a11 * a22 - a12 * a21 > 1e-14 * trace * trace else 1e-12 * (trace + w[0, 0])
    n = x = y = 0.0
    for step in range(100):
        determinant = (a11 + s) * (a22 + s) - a12 * a21
        x = (a12 * g2 - (a22 + s) * g1) / determinant
        y = (a21 * g1 - (a11 + s) * g2) / determinant
        n = stopping - b1 * x - b2 * y
        tangential = np.sqrt(x * x + y * y)
        excess = tangential - mu * n
        # s = 0 within the cone is sticking; later steps end at rounding
        if (step == 0 and excess <= 0.0) or abs(excess) <= 1e-15 * tangential:
            break
        if excess > 0.0:
            low = s
        else:
            high = s
        if high < np.inf and high - low <= 4e-16 * high:
            break
        new = -1.0
        if n > 0.0:
            dx = (a12 * y - (a22 + s) * x) / determinant
            dy = (a21 * x - (a11 + s) * y) / determinant
            # 1/|r_T| is nearly linear in s, |r_T| is not (as in the secular equation of Moré & Sorensen 1983)
            slope = (b1 * dx + b2 * dy) / (mu * n * n) + (x * dx + y * dy) / tangential**3
            new = s + (1.0 / tangential - 1.0 / (mu * n)) / slope if slope != 0.0 else -1.0
        # Newton's step left the bracket: bisect, or go outwards by eight while there is no upper end
        if not low < new < high:
            new = 0.5 * (low + high) if high < np.inf else 8.0 * max(s, 0.05 * (trace + w[0, 0]))
        s = new
    return n, x, y


@compiled
def project_on_cone(n, t, s, friction):
    """Nearest point of the cone |(t, s)| <= friction n to (n, t, s)."""
    tangential = np.sqrt(t * t + s * s)
    if tangential <= friction * n:
        return n, t, s
    # in the polar cone, whose points have the tip as their nearest
    if friction * tangential <= -n:
        return 0.0, 0.0, 0.0
    height = (n + friction * tangential) / (1.0 + friction * friction)
    scale = friction * height / tangential if tangential > 0.0 else 0.0
    return height, scale * t, scale * s


def projections(z: np.ndarray, mu: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nearest points (c, 3) of the cones |(t, s)| <= mu n to `z` (c, 3), and their derivatives by z (c, 3, 3)."""
    tangential = np.hypot(z[:, 1], z[:, 2])
    inside = tangential <= mu * z[:, 0]
    outside = mu * tangential <= -z[:, 0]
    direction = z[:, 1:] / np.where(tangential > 0.0, tangential, 1.0)[:, None]
    share = 1.0 / (1.0 + mu * mu)
    height = share * (z[:, 0] + mu * tangential)
    edge = np.column_stack([np.ones_like(mu), mu[:, None] * direction])
    point = height[:, None] * edge
    derivative = share[:, None, None] * edge[:, :, None] * edge[:, None, :]
    across = np.eye(2) - direction[:, :, None] * direction[:, None, :]
    round_cone = mu * height / np.where(tangential > 0.0, tangential, 1.0)
    derivative[:, 1:, 1:] += round_cone[:, None, None] * across
    # both hold at the tip (0, 0, 0), where the projection has several generalised derivatives: the identity is one
    point[inside], derivative[inside] = z[inside], np.eye(3)
    point[outside & ~inside], derivative[outside & ~inside] = 0.0, 0.0
    return point, derivative
