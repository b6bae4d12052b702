"""Coupled Signorini-Coulomb contacts, each solved by telling apart open, sticking and slipping."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq


def naive_contacts(delassus, free, friction, sweeps=3000):
    """Impulses r with u = W r + q; block Gauss-Seidel with the exact solution of every contact."""
    impulse = np.zeros(free.size)
    for _ in range(sweeps):
        before = impulse.copy()
        for c in range(free.size // 3):
            block = slice(3 * c, 3 * c + 3)
            own = delassus[block, block]
            others = free[block] + delassus[block] @ impulse - own @ impulse[block]
            impulse[block] = one_contact(own, others, friction)
        if np.abs(impulse - before).max() <= 1e-15 * np.abs(impulse).max():
            break
    return impulse


def one_contact(w, q, friction):
    """Impulse of one contact with full 3 x 3 Delassus block w, cases tried in turn."""
    if q[0] >= 0:
        return np.zeros(3)
    sticking = -np.linalg.solve(w, q)
    if np.hypot(*sticking[1:]) <= friction * sticking[0]:
        return sticking

    def slipping(angle):
        direction = np.array([np.cos(angle), np.sin(angle)])
        normal = -q[0] / (w[0, 0] + friction * w[0, 1:] @ direction)
        r = normal * np.array([1.0, *(friction * direction)])
        return r, (w @ r + q)[1:], direction

    def across(angle):
        _, slip, direction = slipping(angle)
        return slip[0] * direction[1] - slip[1] * direction[0]

    angles = np.linspace(0, 2 * np.pi, 181)
    values = [across(a) for a in angles]
    for low, high, v_low, v_high in zip(angles, angles[1:], values, values[1:]):
        if v_low * v_high <= 0:
            r, slip, direction = slipping(brentq(across, low, high, xtol=1e-15, rtol=1e-15))
            if r[0] >= 0 and slip @ direction <= 0:  # friction opposes the slip
                return r
    raise ArithmeticError("no slip direction")
