"""The steps of the reduced model, compiled: it allocates nothing, so that it runs without numba (`native`)."""

from __future__ import annotations

import numpy as np
from numba import carray, cfunc, types

from asphalt_nscd.nscd.bonds.head_kernels import actuator_force, follow_actuator
from asphalt_nscd.nscd.bonds.strength import utilisation
from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.stepping.reduced_steps import (
    ARRAYS,
    CLOSED_GAP,
    DONE,
    OUTSIDE_ENVELOPE,
    RESIDUAL,
    YIELD,
)


@compiled
def take_steps(
    driven,
    devices,
    impedance,
    head_inertia,
    head_strain,
    head_load,
    mass,
    stiffness,
    load,
    inverse,
    dt,
    compliance,
    memory,
    recall,
    keep,
    gain,
    residual_factor,
    head_norm,
    load_norm,
    tolerance,
    reaction,
    beyond_head,
    closing,
    sigma_envelope,
    motion_envelope,
    reached_sigma,
    reached_motion,
    maxima,
    q,
    v,
    s,
    kelvin,
    trial,
    force,
    velocity,
    scratch,
):
    """Steps until the end or the first violation: (steps taken, code, index into the watched bonds).

    State arrays change in place, step by step; `trial` receives v+, s+, q+ of the refused step; scratch (4 k + 1,).
    """
    k = q.shape[0]
    kept = velocity.shape[1]
    scale = dt / compliance
    explicit, known, combined = scratch[:k], scratch[k : 2 * k], scratch[2 * k : 4 * k + 1]
    new_v, new_s, new_q = trial[0], trial[1], trial[2]
    for n in range(driven.shape[0]):
        for a in range(k):
            explicit[a] = memory * s[a]
            for e in range(recall.shape[0]):
                explicit[a] -= recall[e] * kelvin[e, a]
        free_force = -head_load
        for a in range(k):
            free_force -= head_inertia[a] * v[a] + head_strain[a] * explicit[a]
        new_v[0], friction = follow_actuator(devices, dt, free_force, impedance, driven[n], q[0], v[0])
        for a in range(1, k):
            known[a] = dt * load[a] - (mass[a, 0] + scale * stiffness[a, 0]) * new_v[0]
            for b in range(k):
                known[a] += mass[a, b] * v[b] + scale * stiffness[a, b] * explicit[b]
        for a in range(1, k):
            new_v[a] = 0.0
            for b in range(1, k):
                new_v[a] += inverse[a - 1, b - 1] * known[b]
        outside = False
        for a in range(k):
            new_s[a] = (explicit[a] - new_v[a]) / compliance
            new_q[a] = q[a] + dt * new_v[a]
            outside |= abs(new_s[a]) > sigma_envelope[a] or abs(new_q[a]) > motion_envelope[a]
            combined[a] = (new_v[a] - v[a]) / dt
            combined[k + a] = new_s[a]
        combined[2 * k] = 1.0
        if outside:
            return n, OUTSIDE_ENVELOPE, -1
        # an inaccurate trial must not decide on gaps and yield, nor one without its contacts on yield
        stress = max(maxima[0], abs(new_s[0]))
        size = head_norm * stress + load_norm
        missing = _norm_of_product(residual_factor, combined)
        if not missing <= tolerance * size:
            return n, RESIDUAL, -1
        for c in range(closing.shape[0]):
            share = 0.0
            for a in range(k):
                share += closing[c, a] * new_q[a]
            if share > 1.0:
                return n, CLOSED_GAP, c
        worst, most = -1, maxima[2]
        for c in range(reaction.shape[0]):
            if beyond_head[c, 0] * abs(new_s[0]) + beyond_head[c, 1] > most:
                share = _utilisation(reaction[c], new_s)
                if share > most:
                    worst, most = c, share
        if most > 1.0:
            return n, YIELD, worst
        maxima[2] = most
        maxima[0] = stress
        if size > 0.0:
            maxima[1] = max(maxima[1], missing / size)
        force[n] = -load[0]
        for b in range(k):
            force[n] += mass[0, b] * combined[b] - stiffness[0, b] * new_s[b]
        force[n] = actuator_force(devices, dt, force[n], friction, q[0], v[0], new_v[0])
        for a in range(k):
            v[a], s[a], q[a] = new_v[a], new_s[a], new_q[a]
            for e in range(recall.shape[0]):
                kelvin[e, a] = keep[e] * kelvin[e, a] - gain[e] * new_s[a]
            reached_sigma[a] = max(reached_sigma[a], abs(s[a]))
            reached_motion[a] = max(reached_motion[a], abs(q[a]))
            if a < kept:
                velocity[n, a] = v[a]
    return driven.shape[0], DONE, -1


@compiled
def _utilisation(reaction, s):
    normal = tangent = other = 0.0
    for a in range(s.shape[0]):
        normal += reaction[0, a] * s[a]
        tangent += reaction[1, a] * s[a]
        other += reaction[2, a] * s[a]
    return utilisation(normal, tangent, other)


@compiled
def _norm_of_product(upper, vector):
    square = 0.0
    for a in range(upper.shape[0]):
        row = 0.0
        for b in range(a, upper.shape[1]):
            row += upper[a, b] * vector[b]
        square += row * row
    return np.sqrt(square)


_INTEGERS, _DOUBLES = types.CPointer(types.intp), types.CPointer(types.float64)


@cfunc(types.void(_INTEGERS, *[_DOUBLES] * ARRAYS, _INTEGERS), error_model="numpy")
def native_steps(
    sizes,
    numbers,
    devices,
    driven,
    head_inertia,
    head_strain,
    mass,
    stiffness,
    load,
    inverse,
    recall,
    keep,
    gain,
    residual_factor,
    reaction,
    beyond_head,
    closing,
    sigma_envelope,
    motion_envelope,
    reached_sigma,
    reached_motion,
    maxima,
    q,
    v,
    s,
    kelvin,
    trial,
    force,
    velocity,
    scratch,
    taken,
):
    """`take_steps` over pointers to contiguous arrays."""
    size, number, device = carray(sizes, 8), carray(numbers, 8), carray(devices, 4)
    n, k, elements, rows, columns, watched, closed, kept = (
        size[0],
        size[1],
        size[2],
        size[3],
        size[4],
        size[5],
        size[6],
        size[7],
    )
    impedance, head_load, dt, compliance, memory, head_norm, load_norm, tolerance = (
        number[0],
        number[1],
        number[2],
        number[3],
        number[4],
        number[5],
        number[6],
        number[7],
    )
    found = take_steps(
        carray(driven, n),
        (device[0], device[1], device[2], device[3]),
        impedance,
        carray(head_inertia, k),
        carray(head_strain, k),
        head_load,
        carray(mass, (k, k)),
        carray(stiffness, (k, k)),
        carray(load, k),
        carray(inverse, (k - 1, k - 1)),
        dt,
        compliance,
        memory,
        carray(recall, elements),
        carray(keep, elements),
        carray(gain, elements),
        carray(residual_factor, (rows, columns)),
        head_norm,
        load_norm,
        tolerance,
        carray(reaction, (watched, 3, k)),
        carray(beyond_head, (watched, 2)),
        carray(closing, (closed, k)),
        carray(sigma_envelope, k),
        carray(motion_envelope, k),
        carray(reached_sigma, k),
        carray(reached_motion, k),
        carray(maxima, 3),
        carray(q, k),
        carray(v, k),
        carray(s, k),
        carray(kelvin, (elements, k)),
        carray(trial, (3, k)),
        carray(force, n),
        carray(velocity, (n, kept)),
        carray(scratch, 4 * k + 1),
    )
    for place in range(3):
        carray(taken, 3)[place] = found[place]
