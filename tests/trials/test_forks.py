"""A fork ends as a process of its own does, and says what it said."""

from __future__ import annotations

import os

import forks
import pytest

PROGRAM = """
import atexit, os, signal, subprocess, sys, time


def tells():
    print(sys.argv[1:], os.environ["ASKED"], os.path.basename(os.getcwd()), flush=True)
    subprocess.run(["sh", "-c", "echo a child of it >&2"])
    atexit.register(print, "kept at its end")


def refuses():
    sys.exit("refused")


def breaks():
    print("before")
    raise ValueError("broken")


def dies():
    print("before", flush=True)
    os.kill(os.getpid(), signal.SIGKILL)


def hangs():
    print("before", flush=True)
    time.sleep(600)
"""


@pytest.fixture
def run(tmp_path):
    (tmp_path / "program_of_forks.py").write_text(PROGRAM)

    def ran(function, *arguments):
        environment = {**os.environ, "ASKED": "so"}
        done = forks.forked(f"program_of_forks:{function}", [*arguments], tmp_path, environment)
        return done.returncode, done.stdout, done.stderr

    return ran


def test_it_has_its_arguments_environment_and_folder_and_ends_in_full(run, tmp_path):
    said = f"['--option', 'value'] so {tmp_path.name}\nkept at its end\n"
    assert run("tells", "--option", "value") == (0, said, "a child of it\n")


def test_a_refusal_is_a_sentence_and_a_failure_a_traceback(run):
    assert run("refuses") == (1, "", "refused\n")
    status, out, err = run("breaks")
    assert (status, out) == (1, "before\n") and "Traceback" in err and err.endswith("ValueError: broken\n")


def test_one_that_is_killed_or_hangs_is_told_by_its_status(run, monkeypatch):
    assert run("dies") == (-9, "before\n", "")
    monkeypatch.setattr(forks, "LONGEST", 1.0)
    assert run("hangs") == (-9, "before\n", "")
