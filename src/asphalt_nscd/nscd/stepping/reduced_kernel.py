"""The steps of the reduced model, compiled: it allocates nothing, so that it runs without numba (`native`)."""

from __future__ import annotations

import numpy as np
from numba import carray, cfunc, types

from asphalt_nscd.nscd.bonds.head_kernels import actuator_force, follow_actuator
from asphalt_nscd.nscd.bonds.strength import utilisation
from asphalt_nscd.nscd.compiled import compiled
from asphalt_nscd.nscd.stepping.reduced_run import (
    CLOSED_GAP,
    DONE,
    FIELDS,
    OUTSIDE_ENVELOPE,
    RESIDUAL,
    YIELD,
    ReducedRun,
)


@compiled
def take_steps(run):
    """Step until the end or the first violation: (steps taken, code of their end, which of the bonds watched for it).

    State arrays change in place, step by step; `run.trial` receives v+, s+, q+ of the refused step.
    """
    q, v, s, memory, dt, force, maxima = run.q, run.v, run.s, run.memory, run.dt, run.force, run.maxima
    k = q.shape[0]
    kept = run.velocity.shape[1]
    scale = dt / run.compliance
    explicit, known, combined = run.scratch[:k], run.scratch[k : 2 * k], run.scratch[2 * k : 4 * k + 1]
    others, missed = run.scratch[4 * k + 1 : 5 * k], run.scratch[5 * k + 1 :]
    new_v, new_s, new_q = run.trial[0], run.trial[1], run.trial[2]
    for n in range(run.driven.shape[0]):
        for a in range(k):
            explicit[a] = run.recall[0] * s[a]
            for e in range(memory.shape[0]):
                explicit[a] += run.recall[1 + e] * memory[e, a]
        free_force = -run.head_load
        for a in range(k):
            free_force -= run.head_inertia[a] * v[a] + run.head_strain[a] * explicit[a]
        new_v[0], friction = follow_actuator(
            run.devices, dt, free_force, run.impedance, run.driven[n], q[0], v[0]
        )
        for a in range(k):
            known[a] = dt * run.load[a] - (run.mass[0, a] + scale * run.stiffness[0, a]) * new_v[0]
        for b in range(k):
            _add_two(known, run.mass[b], v[b], scale, run.stiffness[b], explicit[b])
        others[:] = 0.0
        for b in range(k - 1):
            _add(others, run.inverse[b], known[b + 1])
        new_v[1:] = others
        outside = False
        for a in range(k):
            new_s[a] = (explicit[a] - new_v[a]) / run.compliance
            new_q[a] = q[a] + dt * new_v[a]
            outside |= abs(new_s[a]) > run.sigma_envelope[a] or abs(new_q[a]) > run.motion_envelope[a]
            combined[a] = (new_v[a] - v[a]) / dt
            combined[k + a] = new_s[a]
        combined[2 * k] = 1.0
        # the bonds watched are those of the envelope: beyond it the trial cannot tell whether one yields
        if outside:
            return n, OUTSIDE_ENVELOPE, -1
        # an inaccurate trial must not decide on gaps and yield, nor one without its contacts on yield
        stress = max(maxima[0], abs(new_s[0]))
        size = run.head_norm * stress + run.load_norm
        missing = _norm_of_product(run.residual_factor, combined, missed)
        # written so that NaN is refused
        if not missing <= run.tolerance * size:
            return n, RESIDUAL, -1
        for c in range(run.closing.shape[0]):
            share = 0.0
            for a in range(k):
                share += run.closing[c, a] * new_q[a]
            if share > 1.0:
                return n, CLOSED_GAP, c
        worst, most = -1, maxima[2]
        for c in range(run.reaction.shape[0]):
            # a bound of two numbers first: rows of k numbers are summed only where it does not settle a bond
            if run.beyond_head[c, 0] * abs(new_s[0]) + run.beyond_head[c, 1] > most:
                share = _utilisation(run.reaction[c], new_s)
                if share > most:
                    worst, most = c, share
        if most > 1.0:
            return n, YIELD, worst
        # from here on the step counts: one that is refused must leave all as it was
        maxima[2] = most
        maxima[0] = stress
        if size > 0.0:
            maxima[1] = max(maxima[1], missing / size)
        force[n] = -run.load[0]
        for b in range(k):
            force[n] += run.mass[b, 0] * combined[b] - run.stiffness[b, 0] * new_s[b]
        force[n] = actuator_force(run.devices, dt, force[n], friction, q[0], v[0], new_v[0])
        for a in range(k):
            v[a], s[a], q[a] = new_v[a], new_s[a], new_q[a]
            for e in range(memory.shape[0]):
                driven = run.gain[e] * new_s[a] + run.follow[e] * new_v[a]
                memory[e, a] = run.decay[e] * memory[e, a] - driven
            run.reached_sigma[a] = max(run.reached_sigma[a], abs(s[a]))
            run.reached_motion[a] = max(run.reached_motion[a], abs(q[a]))
            if a < kept:
                run.velocity[n, a] = v[a]
    return run.driven.shape[0], DONE, -1


@compiled
def _utilisation(reaction, s):
    """How far stresses s (k,) use up a bond, whose `reaction` (3, k) per unit s is over its strength."""
    normal = tangent = other = 0.0
    for a in range(s.shape[0]):
        normal += reaction[0, a] * s[a]
        tangent += reaction[1, a] * s[a]
        other += reaction[2, a] * s[a]
    return utilisation(normal, tangent, other)


# sums over rows, column by column: each sum keeps its order and bits, and many go on at once
@compiled
def _add(total, column, share):
    for a in range(total.shape[0]):
        total[a] += column[a] * share


@compiled
def _add_two(total, column, share, scale, other, share_of_other):
    for a in range(total.shape[0]):
        total[a] += column[a] * share + scale * other[a] * share_of_other


@compiled
def _norm_of_product(columns, vector, rows):
    """Norm of an upper triangle, given by its `columns`, times `vector`; `rows` is scratch."""
    rows[:] = 0.0
    for b in range(vector.shape[0]):
        upper = min(b + 1, rows.shape[0])
        _add(rows[:upper], columns[b], vector[b])
    square = 0.0
    for a in range(rows.shape[0]):
        square += rows[a] * rows[a]
    return np.sqrt(square)


_INTEGERS, _DOUBLES = types.CPointer(types.intp), types.CPointer(types.float64)


@cfunc(types.void(_INTEGERS, types.CPointer(_DOUBLES), _INTEGERS), error_model="numpy")
def native_steps(sizes, fields, taken):
    """`take_steps` on the fields of a `ReducedRun` behind pointers to contiguous doubles, in its order."""
    size = carray(sizes, 8)
    n, k, m, columns = size[0], size[1], size[2], size[3]
    rows, watched, closed, kept = size[4], size[5], size[6], size[7]
    at = carray(fields, FIELDS)
    device = carray(at[1], 4)
    steps = take_steps(
        ReducedRun(
            carray(at[0], n),
            (device[0], device[1], device[2], device[3]),
            carray(at[2], 1)[0],
            carray(at[3], k),
            carray(at[4], k),
            carray(at[5], 1)[0],
            carray(at[6], (k, k)),
            carray(at[7], (k, k)),
            carray(at[8], k),
            carray(at[9], (k - 1, k - 1)),
            carray(at[10], 1)[0],
            carray(at[11], 1)[0],
            carray(at[12], 1 + m),
            carray(at[13], m),
            carray(at[14], m),
            carray(at[15], m),
            carray(at[16], (columns, rows)),
            carray(at[17], 1)[0],
            carray(at[18], 1)[0],
            carray(at[19], 1)[0],
            carray(at[20], (watched, 3, k)),
            carray(at[21], (watched, 2)),
            carray(at[22], (closed, k)),
            carray(at[23], k),
            carray(at[24], k),
            carray(at[25], k),
            carray(at[26], k),
            carray(at[27], 3),
            carray(at[28], k),
            carray(at[29], k),
            carray(at[30], k),
            carray(at[31], (m, k)),
            carray(at[32], (3, k)),
            carray(at[33], n),
            carray(at[34], (n, kept)),
            carray(at[35], 5 * k + rows + 1),
        )
    )
    for place in range(3):
        carray(taken, 3)[place] = steps[place]
