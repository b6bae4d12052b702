"""Rigid spheres and planes with Signorini-Coulomb contacts: one NSCD step.

Moreau-Jean time stepping with impulses (Eq. 14). The nonlinear Gauss-Seidel method visits the
contacts one by one; for spheres the local Delassus operator is diagonal in the contact frame, so
the local problem is solved exactly without ever building tangent vectors (granular_sweeps.py).

Spin is stored as surface velocity s = radius * angular velocity [m/s]: both bodies then enter the
contact in the same way, U = v_j - v_i - (s_i + s_j) x n, and m (2/5) s' = -n x r.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.spheres.gauss_seidel import pack_contacts, pack_motion, place, sweep_until


@compiled
def active_contacts(position, radius, velocity, plane_point, plane_normal, start, other, dt, margin):
    """Pairs that may touch within the step: (pair, first, second, normal (c, 3), gap (c,)).

    A pair is active when its gap, less the approach at the free velocity, is below `margin` [m].
    The normal points from the first body to the second.
    """
    n = position.shape[0]  # the first of them are on the list
    total = other.shape[0]
    pair = np.empty(total, np.int64)
    first = np.empty(total, np.int64)
    second = np.empty(total, np.int64)
    normal = np.empty((total, 3))
    gap = np.empty(total)
    d = np.empty(3)
    count = 0
    for i in range(start.shape[0] - 1):
        for c in range(start[i], start[i + 1]):
            j = other[c]
            if j < n:
                for k in range(3):
                    d[k] = position[j, k] - position[i, k]
                distance = np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
                g = distance - radius[i] - radius[j]
                for k in range(3):
                    d[k] /= distance
            else:
                g = -radius[i]
                for k in range(3):
                    d[k] = -plane_normal[j - n, k]
                    g -= (position[i, k] - plane_point[j - n, k]) * d[k]
            opening = 0.0
            for k in range(3):
                opening += (velocity[j, k] - velocity[i, k]) * d[k]
            if g + dt * min(opening, 0.0) < margin:
                pair[count], first[count], second[count], gap[count] = c, i, j, g
                for k in range(3):
                    normal[count, k] = d[k]
                count += 1
    return pair[:count], first[:count], second[:count], normal[:count], gap[:count]


@compiled
def step(
    position, radius, velocity, inverse_mass, plane_point, plane_normal, gravity,
    start, other, impulse, drive, dt, friction, restitution, recovery_speed, allowed_overlap, margin,
    tolerance, penetration, enough_sweeps, most_sweeps,
):  # fmt: skip
    """Advance spheres by dt [s]; position, velocity and impulse (per pair) change in place.

    position (n, 3) [m]; velocity (n + p, 6) [m/s] (linear, spin; planes last, prescribed);
    inverse_mass (n + p,) [1/kg], zero for planes; gravity (3,) [m/s2]; impulse (pairs, 3) [N s];
    Overlaps beyond allowed_overlap [m] are undone, no faster than by recovery_speed [m/s] (zero: never).
    Sweeps end as in sweep_until; penetration [m] is what a step may add to an overlap.
    drive (2,): speed [m/s] and largest impulse [N s] of the last plane where its mass is finite (guide_wall).
    Returns (sweeps, relative change of the last sweep, largest overlap at the start [m]).
    """
    n = position.shape[0]
    before = velocity.copy()
    for i in range(n):
        for k in range(3):
            velocity[i, k] += dt * gravity[k]
    pair, first, second, normal, gap = active_contacts(
        position, radius, velocity, plane_point, plane_normal, start, other, dt, margin
    )
    target = np.empty(gap.shape[0])
    for c in range(gap.shape[0]):
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        overlap = max(-gap[c] - allowed_overlap, 0.0)
        target[c] = -gap[c] / dt if gap[c] > 0.0 else min(overlap / dt, recovery_speed)
        if restitution > 0.0:
            opening = 0.0
            for k in range(3):
                opening += (before[second[c], k] - before[first[c], k]) * normal[c, k]
            if opening < 0.0 and gap[c] + dt * opening <= 0.0:
                target[c] = -restitution * opening
    motion = pack_motion(velocity, inverse_mass)
    bodies, contacts = pack_contacts(pair, first, second, normal, target, impulse, inverse_mass)
    sweeps, change = sweep_until(
        bodies, contacts, motion, friction, drive, tolerance, penetration / dt, enough_sweeps, most_sweeps
    )
    impulse[:] = 0.0
    for c in range(gap.shape[0]):
        impulse[pair[c]] = contacts[place(c, gap.shape[0]), 3:6]
    velocity[:, :3] = motion[:, :3]
    velocity[:, 3:] = motion[:, 4:7]
    for i in range(n):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]
    overlap = max(0.0, -gap.min()) if gap.shape[0] > 0 else 0.0
    return sweeps, change, overlap
