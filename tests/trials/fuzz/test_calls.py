"""Drawn calls of the public functions: what they draw, how their ends are told apart, and that a few have one."""

from __future__ import annotations

import time

import numpy as np
import pytest
from fuzz import calls, draws

import asphalt_nscd as an


def test_a_seed_repeats_its_call_and_all_functions_are_called():
    assert {calls.called(seed) for seed in range(600)} == {one.__name__ for one in draws.SHARES}
    assert sum(draws.SHARES.values()) == pytest.approx(1.0)
    assert calls.called(7) == calls.called(7)


@pytest.mark.slow
@pytest.mark.parametrize("function", ["law", "solve_contacts", "read", "read_packing", "export"])
def test_a_few_calls_end_in_a_result_or_a_sentence(function):
    seeds = [seed for seed in range(300) if calls.called(seed) == function][:3]
    for seed in seeds:
        assert calls.tried(seed).ended in ("result", "sentence")


@pytest.mark.parametrize(
    ("ends_in", "ended"),
    [
        (an.InputError("counts: no sphere; give at least one."), "sentence"),
        (an.InputError("no"), "traceback"),  # which is no sentence
        (ValueError("math domain error"), "traceback"),
        (RecursionError("too deep"), "traceback"),
    ],
)
def test_only_a_sentence_of_ours_is_one(monkeypatch, ends_in, ended):
    def call():
        raise ends_in

    monkeypatch.setattr(calls, "draw", lambda seed: call)
    assert calls.tried(0).ended == ended


def test_results_are_looked_at(monkeypatch):
    nowhere = an.Packing({"position": np.zeros((1, 3)), "radius": np.ones(1), "box": np.ones(3)}, {})
    nowhere.arrays["position"][:] = np.nan
    monkeypatch.setattr(calls, "draw", lambda seed: lambda: nowhere)
    assert calls.tried(0).ended == "traceback"
    monkeypatch.setattr(calls, "draw", lambda seed: lambda: None)
    assert calls.tried(0).ended == "result"


def endless(pipe):  # in the process of the trial
    calls.LONGEST = 1
    calls.called = lambda seed: "law"
    calls.draw = lambda seed: (lambda: None) if seed else lambda: [time.process_time() for _ in iter(int, 1)]
    calls._serve(pipe)


@pytest.mark.slow
def test_a_call_without_end_is_ended_and_the_next_one_made(monkeypatch):
    serve = calls._serve
    monkeypatch.setattr(calls, "_serve", endless)
    trial = calls.Trial()
    assert trial.of(0).ended == "no end"
    monkeypatch.setattr(calls, "_serve", serve)
    trial.end()


def test_a_trial_goes_on_where_it_stopped_and_counts_all(monkeypatch, tmp_path):
    asked = []

    class Asked:
        def of(self, seed):
            asked.append(seed)
            return calls.Outcome(seed, "law", "no end" if seed == 4 else "result", "said, so", cpu_s=2.0)

        def end(self):
            pass

    monkeypatch.setattr(calls, "Trial", Asked)
    monkeypatch.setattr(calls, "provenance", lambda: {"git_commit": "a"})
    calls.all_tried(range(3, 6), tmp_path)
    rows = (tmp_path / "outcomes.csv").read_text(encoding="utf-8").splitlines()
    (tmp_path / "outcomes.csv").write_text("\n".join(rows[:-1]) + "\n", encoding="utf-8")
    table = calls.counted(calls.all_tried(range(3, 6), tmp_path)).set_index("function")
    assert asked == [3, 4, 5, 5]
    assert table.loc["all", "calls"] == 3
    assert table.loc["law", ["no_end", "result"]].tolist() == [1, 2]
    monkeypatch.setattr(calls, "provenance", lambda: {"git_commit": "b"})
    calls.all_tried(range(3, 6), tmp_path)
    assert asked[4:] == [3, 4, 5]
