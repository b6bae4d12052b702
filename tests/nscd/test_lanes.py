"""Lanes in compiled kernels against the same with numpy, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from asphalt_nscd.nscd.lanes import (
    WIDTH,
    aligned,
    broadcast,
    gather,
    greater_bits,
    largest,
    load,
    scatter,
    select_greater,
    sqrt,
    store,
    total,
    zeros,
)


@pytest.fixture
def numbers():
    array = aligned((3, 4, WIDTH))
    array[:] = np.random.default_rng(1).standard_normal(array.shape)
    return array


def test_rows_are_cache_lines():
    arrays = [aligned((rows, WIDTH)) for rows in range(1, 60)]
    assert all(array.ctypes.data % 64 == 0 and array.flags.c_contiguous for array in arrays)
    assert not any(array.any() for array in arrays)


def test_arithmetic_is_that_of_each_lane(numbers):
    @njit
    def combine(array, block):
        a, b, c = load(array, block, 0), load(array, block, 1), load(array, block, 2)
        store(array, block, 3, a * b - (c + a) / sqrt(b * b))

    a, b, c = numbers[1, :3].copy()
    others = numbers[[0, 2]].copy()
    combine(numbers, 1)
    np.testing.assert_array_equal(numbers[1, 3], a * b - (c + a) / np.sqrt(b * b))
    np.testing.assert_array_equal(numbers[1, :3], [a, b, c])
    np.testing.assert_array_equal(numbers[[0, 2]], others)


def test_each_lane_is_compared_by_itself(numbers):
    @njit
    def compare(array, limit):
        a, b = load(array, 0, 0), load(array, 0, 1)
        store(array, 0, 2, select_greater(a, b, a, broadcast(limit)))
        return greater_bits(a, b), largest(a)

    a, b = numbers[0, :2].copy()
    a[3] = b[3]  # equal is not above
    numbers[0, 0] = a
    bits, most = compare(numbers, 0.25)
    assert bits == sum(1 << lane for lane in range(WIDTH) if a[lane] > b[lane])
    assert 0 < bits < 255
    assert most == a.max()
    np.testing.assert_array_equal(numbers[0, 2], np.where(a > b, a, 0.25))


def test_sum_runs_from_the_first_lane_to_the_last():
    @njit
    def add(array):
        return total(zeros() + load(array, 0, 0))

    array = aligned((1, 1, WIDTH))
    array[0, 0] = [1.0, 1e16, 3.0, -1e16, 5.0, 1e17, 7.0, -1e17]
    assert add(array) == sum(array[0, 0].tolist())


def test_rows_become_columns_and_return():
    @njit
    def shift(rows, which, block, side):
        a, b, c, d, e, f, g, h = gather(rows, which, block, side)
        scatter(rows, which, block, side, (a + b, b, c - a, d, e, f * f, g, h))

    rows = aligned((20, WIDTH))
    rows[:] = np.random.default_rng(2).standard_normal(rows.shape)
    which = np.random.default_rng(3).permutation(20)[: 2 * WIDTH].reshape(1, 2, WIDTH).astype(np.int32)
    expected = rows.copy()
    own = expected[which[0, 1]]
    own[:, 2] -= own[:, 0]
    own[:, 0] += own[:, 1]
    own[:, 5] *= own[:, 5]
    expected[which[0, 1]] = own
    shift(rows, which, 0, 1)
    np.testing.assert_array_equal(rows, expected)
