"""Kernels that run without numba: made once, made anew where their file is damaged, never run on the wrong arrays."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest
from numba import carray, cfunc, types

from asphalt_nscd.nscd import native
from asphalt_nscd.nscd.stepping.reduced_run import ReducedRun
from asphalt_nscd.nscd.stepping.reduced_steps import advance_reduced


@cfunc(types.float64(types.CPointer(types.float64), types.intp), error_model="numpy")
def total(values, count):
    """Sum of the roots."""
    found = 0.0
    for value in carray(values, count):
        found += np.sqrt(value)
    return found


@pytest.fixture
def made(tmp_path, monkeypatch):
    """Calls the kernel through a cache of its own, and counts how often it was made."""
    monkeypatch.setattr(native, "_folder", lambda: tmp_path)
    count = []

    def build():
        count.append(1)
        return total.native_name, total.inspect_llvm()

    def call():
        kernel = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_ssize_t)(
            native.native("total", build)
        )
        values = np.array([1.0, 4.0, 9.0])
        assert kernel(values.ctypes.data, values.size) == 6.0
        return len(count)

    return call


def test_a_kernel_is_made_once(made, tmp_path):
    assert (made(), made()) == (1, 1)
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("place", [0, 70, 500, -1])
def test_a_damaged_kernel_is_made_anew_and_not_run(made, tmp_path, place):
    made()
    (path,) = tmp_path.iterdir()
    content = bytearray(path.read_bytes())
    content[place] ^= 0x10
    path.write_bytes(content)
    assert (made(), made()) == (2, 2)
    path.write_bytes(content[: len(content) // 2])
    assert made() == 3


def test_arrays_of_another_kind_are_refused():
    """By pointers, they would be taken for what they are not."""
    k, one = 3, np.ones(1)
    vector, matrix, small = np.ones(k), np.ones((k, k)), np.ones((k - 1, k - 1))
    arguments = [
        np.ones(5), (0.0, 0.0, 0.0, 0.0), 1.0, vector, vector, 1.0, matrix, matrix, vector, small, 1.0, 1.0,
        np.ones(2), one, one, one, np.ones((7, 7)), 1.0, 1.0, 1.0, np.empty((0, 3, k)), np.empty((0, 2)),
        np.empty((0, k)),
        vector, vector, vector, vector, np.zeros(3), vector, vector, vector, np.ones((1, k)), np.ones((3, k)),
        np.empty(5), np.empty((5, k)), np.empty(5 * k + 8),
    ]  # fmt: skip
    for place, wrong in (
        (6, np.ones((2 * k, k))[::2]),
        (0, np.ones(5, int)),
        (7, np.asfortranarray(np.eye(3)[:, :2])),
    ):
        with pytest.raises(TypeError, match="the kernel takes it for another"):
            advance_reduced(ReducedRun(*arguments[:place], wrong, *arguments[place + 1 :]))
