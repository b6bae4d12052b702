"""Calls the compiled steps of the reduced model without numba, whose import takes longer than most tests."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

DONE, OUTSIDE_ENVELOPE, YIELD, CLOSED_GAP, RESIDUAL = range(5)
"""Why steps ended."""

ARRAYS = 29  # of doubles that `reduced_kernel.native_steps` takes, between two of integers


def advance_reduced(
    driven, devices, impedance, head_inertia, head_strain, head_load, mass, stiffness, load, inverse,
    dt, compliance, memory, recall, keep, gain,
    residual_factor, head_norm, load_norm, tolerance, reaction, beyond_head, closing, sigma_envelope,
    motion_envelope, reached_sigma, reached_motion, maxima, q, v, s, kelvin, trial, force, velocity,
) -> tuple[int, int, int]:  # fmt: skip
    """`reduced_kernel.take_steps` on these arrays."""
    sizes = np.array(
        [driven.size, q.size, recall.size, *residual_factor.shape, len(reaction), len(closing), velocity.shape[1]],
        np.intp,
    )  # fmt: skip
    numbers = [impedance, head_load, dt, compliance, memory, head_norm, load_norm, tolerance]
    taken = np.empty(3, np.intp)
    arrays = (
        np.array(numbers), np.array(devices), driven, head_inertia, head_strain, mass, stiffness, load, inverse,
        recall, keep, gain, residual_factor, reaction, beyond_head, closing, sigma_envelope, motion_envelope,
        reached_sigma, reached_motion, maxima, q, v, s, kelvin, trial, force, velocity, np.empty(4 * q.size + 1),
    )  # fmt: skip
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
