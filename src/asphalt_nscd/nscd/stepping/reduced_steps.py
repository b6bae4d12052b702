"""Calls the compiled steps of the reduced model without numba, whose import takes longer than most tests."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

DONE, OUTSIDE_ENVELOPE, YIELD, CLOSED_GAP, RESIDUAL = range(5)
"""Why steps ended."""

ARRAYS = 29  # of doubles that `reduced_kernel.native_steps` takes, between two of integers


class ReducedRun(NamedTuple):
    """What `reduced_kernel.take_steps` takes, in its order: n steps, k coordinates, e Kelvin elements, c bonds."""

    driven: np.ndarray  # (n,) m, of the actuator
    devices: tuple[float, float, float, float]  # `HeadDevices.of_head`
    impedance: float  # Z: the head takes the force Z v+ - a v - b explicit - c
    head_inertia: np.ndarray  # a (k,)
    head_strain: np.ndarray  # b (k,)
    head_load: float  # c, N
    mass: np.ndarray  # (k, k)
    stiffness: np.ndarray  # (k, k)
    load: np.ndarray  # (k,)
    inverse: np.ndarray  # (k - 1, k - 1) of the step matrix without the head
    dt: float  # s
    compliance: float  # of the law, as those that follow
    memory: float
    recall: np.ndarray  # (e,)
    keep: np.ndarray  # (e,)
    gain: np.ndarray  # (e,)
    residual_factor: np.ndarray  # upper triangle, with 2 k + 1 columns
    head_norm: float
    load_norm: float
    tolerance: float  # of the residual, relative
    reaction: np.ndarray  # (c, 3, k) of bonds watched for yield, over their strength
    beyond_head: np.ndarray  # (c, 2)
    closing: np.ndarray  # (d, k) of d bonds watched for a closing gap, share of it
    sigma_envelope: np.ndarray  # (k,)
    motion_envelope: np.ndarray  # (k,)
    reached_sigma: np.ndarray  # (k,), written, as all that follow
    reached_motion: np.ndarray  # (k,)
    maxima: np.ndarray  # (3,)
    q: np.ndarray  # (k,)
    v: np.ndarray  # (k,)
    s: np.ndarray  # (k,)
    kelvin: np.ndarray  # (e, k)
    trial: np.ndarray  # (3, k)
    force: np.ndarray  # (n,) N
    velocity: np.ndarray  # (n, at most k)


def advance_reduced(run: ReducedRun) -> tuple[int, int, int]:
    """`reduced_kernel.take_steps` on these arrays."""
    watched, closed = len(run.reaction), len(run.closing)
    sizes = np.array(
        [
            run.driven.size,
            run.q.size,
            run.recall.size,
            *run.residual_factor.shape,
            watched,
            closed,
            run.velocity.shape[1],
        ],
        np.intp,
    )
    numbers = [
        run.impedance,
        run.head_load,
        run.dt,
        run.compliance,
        run.memory,
        run.head_norm,
        run.load_norm,
        run.tolerance,
    ]
    taken = np.empty(3, np.intp)
    arrays = (
        np.array(numbers),
        np.array(run.devices),
        run.driven,
        run.head_inertia,
        run.head_strain,
        run.mass,
        run.stiffness,
        run.load,
        run.inverse,
        run.recall,
        run.keep,
        run.gain,
        run.residual_factor,
        run.reaction,
        run.beyond_head,
        run.closing,
        run.sigma_envelope,
        run.motion_envelope,
        run.reached_sigma,
        run.reached_motion,
        run.maxima,
        run.q,
        run.v,
        run.s,
        run.kelvin,
        run.trial,
        run.force,
        run.velocity,
        np.empty(4 * run.q.size + 1),
    )
    _kernel()(
        _address(sizes, np.intp), *(_address(array, float) for array in arrays), _address(taken, np.intp)
    )
    steps, code, bond = taken.tolist()
    return steps, code, bond


def _address(array: np.ndarray, kind: type) -> int:
    if array.dtype != kind or not array.flags.c_contiguous:
        raise TypeError(f"{array.dtype} array of strides {array.strides}: the kernel takes it for another")
    return array.ctypes.data


@cache
def _kernel() -> Callable[..., Any]:
    from asphalt_nscd.nscd.native import native

    return ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * (ARRAYS + 2))(native("reduced-steps", _build))


def _build() -> tuple[str, str]:
    from asphalt_nscd.nscd.stepping.reduced_kernel import native_steps

    return native_steps.native_name, native_steps.inspect_llvm()
