from __future__ import annotations

import errno
import subprocess
import sys

import pytest

from asphalt_nscd.workflow_support import lock

HOLD = """
import sys
from asphalt_nscd.workflow_support.lock import release_stale_locks
print(release_stale_locks(sys.argv[1]), flush=True)
sys.stdin.read()
"""


@pytest.fixture
def directory(tmp_path, monkeypatch):
    monkeypatch.setattr(lock, "_alive", [])
    (tmp_path / "locks").mkdir()
    (tmp_path / "locks/0.output.lock").write_text("results/paper/simulations.csv\n")
    return tmp_path


@pytest.fixture
def other(directory):
    """Another process that holds the directory until it is killed."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, directory], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    yield process
    process.kill()
    process.wait()


def test_locks_of_nobody_are_removed(directory):
    assert lock.release_stale_locks(directory) is True
    assert not list((directory / "locks").iterdir())


def test_locks_of_a_living_process_stay_and_those_of_a_killed_one_go(directory, other):
    assert other.stdout.readline() == "True\n"
    written = directory / "locks/1.output.lock"
    written.write_text("results/paper/audit.csv\n")  # just now, and not held yet
    assert lock.release_stale_locks(directory) is False
    assert written.exists()

    other.kill()
    other.wait()
    lock._alive.clear()
    assert lock.release_stale_locks(directory) is True
    assert not written.exists()


def test_directory_is_made(tmp_path):
    assert lock.release_stale_locks(tmp_path / ".snakemake") is True


@pytest.mark.parametrize("number", [errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_file_system_without_locks_leaves_them_alone(directory, monkeypatch, number):
    def flock(*_):
        raise OSError(number, "no locks")

    monkeypatch.setattr(lock.fcntl, "flock", flock)
    assert lock.release_stale_locks(directory) is None
    assert (directory / "locks/0.output.lock").exists()
