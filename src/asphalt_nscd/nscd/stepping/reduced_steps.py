"""Calls the compiled steps of the reduced model without numba, whose import takes longer than most tests."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from asphalt_nscd.nscd.stepping.reduced_run import ReducedRun


def advance_reduced(run: ReducedRun) -> tuple[int, int, int]:
    """Call `reduced_kernel.take_steps` on this run: steps taken, the code of their end, which bond yields.

    Its arrays must be contiguous doubles, else TypeError; those from `reached_sigma` on change in place.
    """
    sizes = [run.driven.size, run.q.size, run.decay.size, *run.residual_factor.shape]
    sizes += [len(run.reaction), len(run.closing), run.velocity.shape[1]]
    counts, taken = np.array(sizes, np.intp), np.empty(3, np.intp)
    # held by name until the call is over: the kernel has nothing but addresses
    held = [value if isinstance(value, np.ndarray) else _numbers(value) for value in run]
    addresses = np.array([_address(value) for value in held], np.uintp)
    _kernel()(counts.ctypes.data, addresses.ctypes.data, taken.ctypes.data)
    steps, code, bond = taken.tolist()
    return steps, code, bond


def _numbers(value: float | tuple[float, ...]) -> array[float]:
    return array("d", value if isinstance(value, tuple) else (value,))


def _address(value: np.ndarray | array[float]) -> int:
    """Address of contiguous doubles; TypeError for anything else."""
    if isinstance(value, array):
        return value.buffer_info()[0]
    if value.dtype != float or not value.flags.c_contiguous:
        raise TypeError(f"{value.dtype} array of strides {value.strides}: the kernel takes it for another")
    return value.ctypes.data


@cache
def _kernel() -> Callable[..., Any]:
    from asphalt_nscd.nscd.native import native

    return ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)(native("reduced-steps", _build))


def _build() -> tuple[str, str]:
    from asphalt_nscd.nscd.stepping.reduced_kernel import native_steps

    return native_steps.native_name, native_steps.inspect_llvm()
