"""Rigid spheres and planes with Signorini-Coulomb contacts: one NSCD step.

Moreau-Jean time stepping with impulses (Eq. 14). The nonlinear Gauss-Seidel method visits the
contacts one by one; for spheres the local Delassus operator is diagonal in the contact frame, so
the local problem is solved exactly without ever building tangent vectors:
normal 1/m_i + 1/m_j, tangential 7/2 of it.

Spin is stored as surface velocity s = radius * angular velocity [m/s]: both bodies then enter the
contact in the same way, U = v_j - v_i - (s_i + s_j) x n, and m (2/5) s' = -n x r.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled


@compiled
def active_contacts(position, radius, velocity, plane_point, plane_normal, start, other, dt, margin):
    """Pairs that may touch within the step: (pair, first, second, normal (c, 3), gap (c,)).

    A pair is active when its gap, less the approach at the free velocity, is below `margin` [m].
    The normal points from the first body to the second.
    """
    n = position.shape[0]
    total = other.shape[0]
    pair = np.empty(total, np.int64)
    first = np.empty(total, np.int64)
    second = np.empty(total, np.int64)
    normal = np.empty((total, 3))
    gap = np.empty(total)
    d = np.empty(3)
    count = 0
    for i in range(n):
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
def apply_impulse(i, j, normal, impulse, velocity, inverse_mass):
    """Give `impulse` [N s] to body j and its opposite to body i at their point of contact."""
    wi, wj = inverse_mass[i], inverse_mass[j]
    nx, ny, nz = normal[0], normal[1], normal[2]
    px, py, pz = impulse[0], impulse[1], impulse[2]
    tx = 2.5 * (ny * pz - nz * py)
    ty = 2.5 * (nz * px - nx * pz)
    tz = 2.5 * (nx * py - ny * px)
    velocity[i, 0] -= wi * px
    velocity[i, 1] -= wi * py
    velocity[i, 2] -= wi * pz
    velocity[i, 3] -= wi * tx
    velocity[i, 4] -= wi * ty
    velocity[i, 5] -= wi * tz
    velocity[j, 0] += wj * px
    velocity[j, 1] += wj * py
    velocity[j, 2] += wj * pz
    velocity[j, 3] -= wj * tx
    velocity[j, 4] -= wj * ty
    velocity[j, 5] -= wj * tz


@compiled
def sweep_contacts(
    first, second, normal, target, impulse, velocity, inverse_mass, friction, begin, end, stride
):
    """One Gauss-Seidel sweep over contacts begin, begin + stride, ...; updates impulse and velocity.

    Signorini on velocities: opening >= target, impulse >= 0, complementary; Coulomb with `friction`.
    Returns the sums of squares of the change of impulse and of the impulse.
    """
    changed = 0.0
    size = 0.0
    delta = np.empty(3)
    for c in range(begin, end, stride):
        i, j = first[c], second[c]
        nx, ny, nz = normal[c, 0], normal[c, 1], normal[c, 2]
        sx = velocity[i, 3] + velocity[j, 3]
        sy = velocity[i, 4] + velocity[j, 4]
        sz = velocity[i, 5] + velocity[j, 5]
        ux = velocity[j, 0] - velocity[i, 0] - (sy * nz - sz * ny)
        uy = velocity[j, 1] - velocity[i, 1] - (sz * nx - sx * nz)
        uz = velocity[j, 2] - velocity[i, 2] - (sx * ny - sy * nx)
        compliance = inverse_mass[i] + inverse_mass[j]
        px, py, pz = impulse[c, 0], impulse[c, 1], impulse[c, 2]
        opening = ux * nx + uy * ny + uz * nz
        old_normal = px * nx + py * ny + pz * nz
        new_normal = old_normal - (opening - target[c]) / compliance
        if new_normal <= 0.0:
            qx = qy = qz = 0.0
        else:
            scale = 1.0 / (3.5 * compliance)
            qx = px - old_normal * nx - scale * (ux - opening * nx)
            qy = py - old_normal * ny - scale * (uy - opening * ny)
            qz = pz - old_normal * nz - scale * (uz - opening * nz)
            tangential = np.sqrt(qx * qx + qy * qy + qz * qz)
            limit = friction * new_normal
            if tangential > limit:
                qx *= limit / tangential
                qy *= limit / tangential
                qz *= limit / tangential
            qx += new_normal * nx
            qy += new_normal * ny
            qz += new_normal * nz
        delta[0], delta[1], delta[2] = qx - px, qy - py, qz - pz
        moved = delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]
        if moved > 0.0:
            apply_impulse(i, j, normal[c], delta, velocity, inverse_mass)
            impulse[c, 0], impulse[c, 1], impulse[c, 2] = qx, qy, qz
        changed += moved
        size += qx * qx + qy * qy + qz * qz
    return changed, size


@compiled
def solve_contacts_by_sweeps(
    first, second, normal, target, impulse, velocity, inverse_mass, friction, tolerance, most_sweeps
):
    """Gauss-Seidel from the given impulses until their relative change in a sweep is below tolerance.

    Sweeps run alternately up and down the list, which carries weight through a pile in one pass.
    Returns (sweeps, relative change of the last sweep).
    """
    contacts = first.shape[0]
    change = 0.0
    for c in range(contacts):
        apply_impulse(first[c], second[c], normal[c], impulse[c], velocity, inverse_mass)
    for sweep in range(most_sweeps):
        if sweep % 2 == 0:
            changed, size = sweep_contacts(
                first, second, normal, target, impulse, velocity, inverse_mass, friction, 0, contacts, 1
            )
        else:
            changed, size = sweep_contacts(
                first, second, normal, target, impulse, velocity, inverse_mass, friction, contacts - 1, -1, -1
            )
        change = np.sqrt(changed / size) if size > 0.0 else 0.0
        if change < tolerance:
            return sweep + 1, change
    return most_sweeps, change


@compiled
def step(
    position, radius, velocity, inverse_mass, plane_point, plane_normal, gravity,
    start, other, impulse, dt, friction, restitution, recovery_speed, margin,
    tolerance, most_sweeps,
):  # fmt: skip
    """Advance spheres by dt [s]; position, velocity and impulse (per pair) change in place.

    position (n, 3) [m]; velocity (n + p, 6) [m/s] (linear, spin; planes last, prescribed);
    inverse_mass (n + p,) [1/kg], zero for planes; gravity (3,) [m/s2]; impulse (pairs, 3) [N s];
    recovery_speed [m/s] limits how fast overlaps are undone (zero: never).
    Returns (active contacts, sweeps, relative change of the last sweep).
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
    warm = np.empty((gap.shape[0], 3))
    for c in range(gap.shape[0]):
        # an open gap may close within the step; an overlap left by an unconverged step is undone slowly
        target[c] = -gap[c] / dt if gap[c] > 0.0 else min(-gap[c] / dt, recovery_speed)
        if restitution > 0.0:
            opening = 0.0
            for k in range(3):
                opening += (before[second[c], k] - before[first[c], k]) * normal[c, k]
            if opening < 0.0 and gap[c] + dt * opening <= 0.0:
                target[c] = -restitution * opening
        warm[c] = impulse[pair[c]]
    sweeps, change = solve_contacts_by_sweeps(
        first, second, normal, target, warm, velocity, inverse_mass, friction, tolerance, most_sweeps
    )
    impulse[:] = 0.0
    for c in range(gap.shape[0]):
        impulse[pair[c]] = warm[c]
    for i in range(n):
        for k in range(3):
            position[i, k] += dt * velocity[i, k]
    return gap.shape[0], sweeps, change
