"""Layouts of laboratories: each is read as it was meant, and a wrong reading is seen."""

from __future__ import annotations

from dataclasses import replace

import pytest
from layouts.generator import FAMILIES, draw
from layouts.score import outcome


@pytest.mark.parametrize("seed", range(len(FAMILIES)))
def test_each_layout_is_read(tmp_path, seed):
    _, path, tests = draw(seed, tmp_path)
    assert outcome(path, tests) == ("read", "")


def test_a_wrong_reading_is_seen(tmp_path):
    _, path, tests = draw(0, tmp_path)
    key = next(iter(tests.values))
    modulus, phase = tests.values[key]
    for other in ((1.05 * modulus, phase), (modulus, phase + 0.3)):
        assert outcome(path, replace(tests, values=tests.values | {key: other}))[0] == "wrong"
    a, b, *_ = tests.specimens
    other = {a: b, b: a}
    swapped = {(other.get(s, s) if t == key[1] else s, t, f): v for (s, t, f), v in tests.values.items()}
    assert outcome(path, replace(tests, values=swapped))[0] == "wrong"
