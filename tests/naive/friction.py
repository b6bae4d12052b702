"""Coupled Signorini-Coulomb contacts, each solved by telling apart open, sticking and slipping."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq


def naive_contacts(delassus, free, friction, sweeps=3000):
    """Impulses r with u = W r + q; block Gauss-Seidel with the exact solution of every contact."""
    impulse = np.zeros(free.size)
    for _ in range(sweeps):
        before = impulse.copy()
        impulse = naive_sweep(delassus, free, friction, impulse)
        if np.abs(impulse - before).max() <= 1e-15 * np.abs(impulse).max():
            break
    return impulse


def naive_sweep(delassus, free, friction, impulse):
    """Every contact solved once in turn."""
    impulse = impulse.copy()
    for c in range(free.size // 3):
        block = slice(3 * c, 3 * c + 3)
        own = delassus[block, block]
        others = free[block] + delassus[block] @ impulse - own @ impulse[block]
        impulse[block] = one_contact(own, others, friction)
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


def naive_natural_map(delassus, free, friction, impulse):
    """Both errors, written out with norms; friction is one number or one for each contact.

    The second is that of the worst part, of contacts that are coupled to no others.
    """
    contacts = free.size // 3
    mu = np.broadcast_to(friction, contacts)
    u = (delassus @ impulse + free).reshape(-1, 3)
    r, q = impulse.reshape(-1, 3), free.reshape(-1, 3)
    rho = np.array([3 / np.trace(delassus[3 * c : 3 * c + 3, 3 * c : 3 * c + 3]) for c in range(contacts)])

    def miss(c, unit):
        shifted = u[c] + [mu[c] * np.hypot(u[c, 1], u[c, 2]), 0, 0]
        return (r[c] - nearest_in_cone(r[c] - unit * shifted, mu[c])) / np.sqrt(unit)

    plain = np.linalg.norm([miss(c, 1.0) for c in range(contacts)])
    plain /= max(np.linalg.norm(q), np.linalg.norm(r), np.linalg.norm(u))
    root = np.sqrt(rho)[:, None]
    scaled = []
    for part in parts(delassus):
        missed = np.linalg.norm([miss(c, rho[c]) for c in part])
        rounding = 2.0**-52 * np.linalg.norm((r / root)[part])
        scaled.append(
            max(missed, rounding) / max(np.linalg.norm((root * q)[part]), 1e-6 * np.linalg.norm(root * q))
        )
    return plain, max(scaled)


def parts(delassus):
    """Lists of contacts that are coupled with each other and with no others."""
    left, found = set(range(len(delassus) // 3)), []
    while left:
        part, new = [], [left.pop()]
        while new:
            c = new.pop()
            part.append(c)
            of_c = delassus[3 * c : 3 * c + 3] != 0.0, delassus[:, 3 * c : 3 * c + 3] != 0.0
            coupled = set(np.flatnonzero(of_c[0].any(axis=0) | of_c[1].any(axis=1)) // 3) & left
            left -= coupled
            new += coupled
        found.append(sorted(part))
    return found


def nearest_in_cone(z, mu):
    """Projection on |z_T| <= mu z_n: the point itself, the tip, or the foot on the nearest ray."""
    tangential = np.hypot(z[1], z[2])
    if tangential <= mu * z[0]:
        return np.array(z)
    direction = z[1:] / tangential
    ray = np.array([1.0, *(mu * direction)]) / np.sqrt(1 + mu**2)
    return max(ray @ z, 0.0) * ray


def naive_extrapolation(results, changes, damping=1e-10):
    """Anderson's combination of results, oldest first: the last change, least over the differences."""
    g, f = np.diff(results, axis=0), np.diff(changes, axis=0)
    normal = f @ f.T
    normal += damping * np.trace(normal) * np.eye(len(f))
    return results[-1] - np.linalg.solve(normal, f @ changes[-1]) @ g
