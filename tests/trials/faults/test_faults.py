"""What judges the faults, on its own; `make faults` does them all."""

from __future__ import annotations

import time

from comparison import differences
from faults.ended import killed
from faults.study import Missed, Victims
from faults.table import standing


def test_one_job_of_a_rule_gets_the_signal_and_one_too_quick_gives_way(monkeypatch):
    ended = []
    monkeypatch.setattr("os.kill", lambda number, signum: ended.append(number))
    victims = Victims({"a": "fit", "b": "fit", "c": "trim"}, lambda log: 0.01)
    victims.look({"a": 1, "c": 3})
    victims.look({"b": 2, "c": 3, "of another rule": 4})  # a has ended
    time.sleep(0.02)
    victims.look({"b": 2, "c": 3})
    victims.look({"b": 2})
    time.sleep(0.02)
    victims.look({"b": 2})
    assert sorted(ended) == [2, 3] and victims.killed == {"fit": "b", "trim": "c"}


def test_a_job_of_a_tenth_of_a_second_is_killed_too(tmp_path):
    class QuickStudy:
        results = tmp_path

        def killed(self, log, delay):
            (tmp_path / "T0.json").touch()
            if delay > 0.1:
                raise Missed(log)
            return delay

    (tmp_path / "T0.json").touch()
    assert killed("published_law", "T0.json", "T0.log").disturb(QuickStudy()) < 0.1


def test_provenance_makes_no_difference_and_a_number_does(tmp_path):
    for name, commit in (("first", "a" * 40), ("second", "b" * 40 + "-dirty")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "diagnosis.json").write_text(f'{{"x": 1, "git_commit": "{commit}"}}\n')
    folders = tmp_path / "first", tmp_path / "second"
    assert differences(*folders) == []
    (tmp_path / "second/diagnosis.json").write_text('{"x": 2, "git_commit": ""}\n')
    assert differences(*folders) == ["diagnosis.json: differs"]


def test_no_two_faults_share_a_name():
    names = [fault.name for faults in standing().values() for fault in faults]
    assert len(names) == len(set(names)) >= 25
