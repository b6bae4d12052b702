"""Layouts of laboratories: each is read as it was meant, and a wrong reading is seen."""

from __future__ import annotations

from dataclasses import replace

import pytest
from layouts.families import FAMILIES, LATER_FAMILIES
from layouts.files import draw
from layouts.mends import User
from layouts.refusals import LATER, obeyed
from layouts.score import outcome


@pytest.mark.parametrize("seed", range(len(FAMILIES)))
def test_each_layout_is_read(tmp_path, seed):
    family, path, tests = draw(seed, tmp_path)
    assert outcome(path, tests, "M1" if family == "two_mixes" else None) == ("read", "")


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


@pytest.mark.parametrize("seed", [*range(0, 22, 2), 5, 7, 17, 19])
def test_what_a_refusal_asks_mends_the_file(tmp_path, seed):
    tried = obeyed(seed, tmp_path)
    assert tried is None or tried.result == "read", tried.sentences


@pytest.mark.parametrize("seed", [8_000_057, 8_000_058])
def test_what_a_draw_showed_is_mended(tmp_path, seed):
    assert obeyed(seed, tmp_path, LATER, [*LATER_FAMILIES, *FAMILIES]).result == "read"


def test_a_mend_that_is_not_done_leaves_the_file_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(User, "obey", lambda user, sentence: True)
    assert obeyed(5, tmp_path).result == "refused"
