"""Block Gauss-Seidel on frictional contacts, each solved exactly, and its Anderson acceleration.

The plain method stalls where more contacts hold a body than it needs. Extrapolating from the last
few sweeps (Walker and Ni, SIAM J. Numer. Anal. 49, 2011) takes a tenth of the sweeps on most problems.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.contacts.coulomb import one_contact, project_on_cone

_DEPTH = 4  # sweeps that an extrapolation looks back on; more save nothing
_CHECK = 10  # sweeps between two computations of the error
_ASTRAY = 4.0  # growth of the square of a sweep's change that is not forgiven
_ROUNDING = 2.0**-52
_PATIENCE = 300  # sweeps that may pass without the error falling to a tenth
_LARGEST = 1e200  # squares beyond it are of sweeps that diverge
_FAINT = 1e-12  # of all that moves, in squares: a part that moves less is not judged by its own motion


@compiled
def accelerated_sweeps(start, other, block, q, friction, length, part, tolerance, most_sweeps, first):
    """Extrapolated Gauss-Seidel sweeps until both errors are below `tolerance` or progress ends.

    `start` to `part` are as of a `ContactProblem`; `first` (3 c,) are the reactions to start from. Returns the
    reactions (3 c,) of the least error and the number of sweeps.
    """
    rows = q.shape[0]
    r, swept, best = first.copy(), np.zeros(rows), first.copy()
    last, change, last_change = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    of_results, of_changes = np.zeros((_DEPTH, rows)), np.zeros((_DEPTH, rows))
    normal = np.zeros((_DEPTH, _DEPTH))
    # impulses over the root of the step length are roots of energies: light and heavy contacts then count
    # alike
    weight = np.repeat(1.0 / np.sqrt(length), 3)
    kept, last_size = 0, np.inf
    least = mark = np.inf
    mark_sweep = 0
    for sweep in range(1, most_sweeps + 1):
        swept[:] = r
        sweep_once(start, other, block, q, friction, swept)
        size = whole = 0.0
        for i in range(rows):
            change[i] = weight[i] * (swept[i] - r[i])
            size += change[i] ** 2
            whole += (weight[i] * swept[i]) ** 2
        # written so that NaN ends here too
        if not size + whole < _LARGEST:
            return best, sweep
        # the natural map costs as much as a sweep, so it is looked at in every tenth, and where the change
        # says that the end is near
        if sweep % _CHECK == 0 or sweep == most_sweeps or size <= tolerance**2 * whole:
            error = max(natural_map(start, other, block, q, friction, length, part, swept))
            # of swept reactions alone: extrapolated ones may lie outside the cones
            if error < least:
                least = error
                best[:] = swept
            if least <= tolerance:
                return best, sweep
            if error <= 0.1 * mark:
                mark, mark_sweep = error, sweep
            # stalled: more sweeps would not help, what comes next may
            elif sweep - mark_sweep > _PATIENCE:
                return best, sweep
        if size > _ASTRAY * last_size:  # the extrapolation led astray: back to the last result, anew
            r[:] = last
            kept, last_size = 0, np.inf
            continue
        if last_size < np.inf:
            slot = kept % _DEPTH
            for i in range(rows):
                of_results[slot, i] = swept[i] - last[i]
                of_changes[slot, i] = change[i] - last_change[i]
            kept += 1
            for k in range(min(kept, _DEPTH)):
                normal[slot, k] = normal[k, slot] = _dot(of_changes[slot], of_changes[k])
        last[:], last_change[:], last_size = swept, change, size
        r[:] = extrapolated(swept, change, of_results, of_changes, normal, min(kept, _DEPTH))
    return best, most_sweeps


@compiled
def extrapolated(result, change, of_results, of_changes, normal, kept):
    """The result (rows,) for which the change of a sweep would be least, to first order (Walker & Ni 2011).

    `result` and `change` (rows,) are of the last sweep; `of_results` and `of_changes` (>= kept, rows) are differences
    between successive sweeps, of which `kept` count; `normal` (>= kept, >= kept) are products of the latter.
    """
    combined = result.copy()
    # changes of successive sweeps become parallel as the method stalls; without damping the shares grow
    # without bound
    damping = 1e-10 * np.trace(normal[:kept, :kept])
    if damping <= 0.0:
        return combined
    right = np.empty(kept)
    for k in range(kept):
        right[k] = _dot(of_changes[k], change)
    share = np.linalg.solve(normal[:kept, :kept] + damping * np.eye(kept), right)
    for k in range(kept):
        for i in range(result.shape[0]):
            combined[i] -= share[k] * of_results[k, i]
    return combined


@compiled
def _dot(a, b):
    """Product summed in one order, whatever the threads of the linear algebra."""
    total = 0.0
    for i in range(a.shape[0]):
        total += a[i] * b[i]
    return total


@compiled
def sweep_once(start, other, block, q, friction, r):
    """Solve each contact in turn with all others held; r (3 c,) [N s] changes in place.

    Block row a of W has blocks start[a]:start[a + 1], each `block` (k, 3, 3) [1/kg] in block column `other` (k,); W_aa
    must be among them. `q` (3 c,) is the free velocity [m/s], normal first; `friction` (c,).
    """
    each, free = r.reshape(-1, 3), q.reshape(-1, 3)
    for a in range(friction.shape[0]):
        u0, u1, u2 = free[a, 0], free[a, 1], free[a, 2]
        own = a
        for k in range(start[a], start[a + 1]):
            b = other[k]
            if b == a:
                own = k
            else:
                w, n, t, s = block[k], each[b, 0], each[b, 1], each[b, 2]
                u0 += w[0, 0] * n + w[0, 1] * t + w[0, 2] * s
                u1 += w[1, 0] * n + w[1, 1] * t + w[1, 2] * s
                u2 += w[2, 0] * n + w[2, 1] * t + w[2, 2] * s
        each[a, 0], each[a, 1], each[a, 2] = one_contact(block[own], u0, u1, u2, friction[a])


@compiled
def natural_map(start, other, block, q, friction, length, part, r):
    """Two errors of reactions `r` (3 c,) [N s], as Siconos states it and free of units; infinite if a value is.

    |r - P_K(r - (u + mu |u_T| n))| / max(|q|, |r|, |u|) adds impulses to velocities, so that it depends on the units,
    and becomes small where reactions grow without end. The second takes r / sqrt(rho) and u sqrt(rho), both square
    roots of energies, with step lengths rho_a = `length`, is relative to |q| alone, and at least the rounding of r. It
    is that of the worst part: contacts that nothing couples to the others answer for themselves.
    """
    plain = frees = forces = speeds = 0.0
    parts = part.max() + 1
    distance, pressing, available = np.zeros(parts), np.zeros(parts), np.zeros(parts)
    each, velocity = r.reshape(-1, 3), q.reshape(-1, 3)
    for a in range(friction.shape[0]):
        u0, u1, u2 = velocity[a, 0], velocity[a, 1], velocity[a, 2]
        free = u0 * u0 + u1 * u1 + u2 * u2
        for k in range(start[a], start[a + 1]):
            w, n, t, s = block[k], each[other[k], 0], each[other[k], 1], each[other[k], 2]
            u0 += w[0, 0] * n + w[0, 1] * t + w[0, 2] * s
            u1 += w[1, 0] * n + w[1, 1] * t + w[1, 2] * s
            u2 += w[2, 0] * n + w[2, 1] * t + w[2, 2] * s
        r0, r1, r2 = each[a, 0], each[a, 1], each[a, 2]
        shifted = u0 + friction[a] * np.sqrt(u1 * u1 + u2 * u2)
        force = r0 * r0 + r1 * r1 + r2 * r2
        frees, forces, speeds = frees + free, forces + force, speeds + u0 * u0 + u1 * u1 + u2 * u2
        p0, p1, p2 = project_on_cone(r0 - shifted, r1 - u1, r2 - u2, friction[a])
        plain += (r0 - p0) ** 2 + (r1 - p1) ** 2 + (r2 - p2) ** 2
        h = length[a]
        p0, p1, p2 = project_on_cone(r0 - h * shifted, r1 - h * u1, r2 - h * u2, friction[a])
        distance[part[a]] += ((r0 - p0) ** 2 + (r1 - p1) ** 2 + (r2 - p2) ** 2) / h
        pressing[part[a]] += force / h
        available[part[a]] += free * h
    if not np.isfinite(plain + frees + forces + speeds + distance.sum() + pressing.sum()):
        return np.inf, np.inf
    tiny = 1e-300  # no motion and no force is no error
    faint = max(_FAINT * available.sum(), tiny)
    worst = 0.0
    for k in range(parts):
        # no error is smaller than the rounding of its reactions, which may be large where a part is tightly
        # held
        missed = max(distance[k], _ROUNDING**2 * pressing[k])
        worst = max(worst, missed / max(available[k], faint))
    return np.sqrt(plain / max(frees, forces, speeds, tiny)), np.sqrt(worst)
