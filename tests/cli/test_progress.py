"""Progress bars: none for what is over in a moment, else with the time since the stage began."""

from __future__ import annotations

import sys

import tqdm.std

from asphalt_nscd.cli import _progress


def said(monkeypatch, capsys, seconds, stages=("stage",)):
    """What `bars` says of stages of ten parts that take so long each."""
    now = [1000.0]
    for clock in (_progress.time, tqdm.std):
        monkeypatch.setattr(clock, "time", lambda: now[0])
    with _progress.bars("s") as report:
        for stage in stages:
            for part in range(11):
                report(stage, part, 10)
                now[0] += seconds / 11
    return capsys.readouterr().err


def test_a_short_stage_says_nothing_and_loads_nothing(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm", None)  # which makes an import fail
    assert said(monkeypatch, capsys, 0.9, ("one", "another")) == ""


def test_a_long_stage_is_told_from_its_beginning(monkeypatch, capsys):
    text = said(monkeypatch, capsys, 22.0)
    assert "stage: 100%" in text and "00:22 elapsed" in text
    assert "stage: 100%" in said(monkeypatch, capsys, 1.2)
