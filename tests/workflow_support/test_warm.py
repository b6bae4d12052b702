"""A step that is handed to the warm process is, from outside, the step that its command would start."""

from __future__ import annotations

import os
import selectors
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from asphalt_nscd.workflow_support import warm

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="warm processes are of Linux")
SCRIPT = """
import os, sys, time
warm = "asphalt_nscd.files.errors" in sys.modules
import asphalt_nscd.files.errors
what, *words = sys.argv[1:]
print(warm, os.getcwd(), os.environ.get("MINE"), *words)
print("aside", file=sys.stderr)
if what == "wait":
    open(words[0], "w").write(str(os.getpid()))
    try:
        time.sleep(60)
    except KeyboardInterrupt:
        sys.exit(130)
sys.exit(int(what))
"""


@pytest.fixture
def command(tmp_path, monkeypatch):
    """A command with a warm process, which has run once."""
    script = tmp_path / "step"
    script.write_text(f"#!{sys.executable}\n{SCRIPT}")
    script.chmod(0o700)
    monkeypatch.setenv("PATH", os.environ["PATH"])
    # What a shell starts in the background ignores an interrupt, and so does all that it starts.
    ignored = signal.signal(signal.SIGINT, signal.default_int_handler)
    process = warm.start(str(script))
    address = Path(os.environ["PATH"].split(os.pathsep)[0], warm.ADDRESS)
    until(address.exists)
    assert run("0", cwd=tmp_path).stdout.startswith("False ")
    until(lambda: run("0", cwd=tmp_path).stdout.startswith("True "))
    yield process
    process.communicate()
    signal.signal(signal.SIGINT, ignored)
    shutil.rmtree(address.parent, ignore_errors=True)  # of a process that was killed


def run(*words: str, **how) -> subprocess.CompletedProcess:
    return subprocess.run(["step", *words], capture_output=True, text=True, timeout=60, **how)


def until(true, longest=30.0) -> None:
    for _ in range(int(longest / 0.05)):
        if true():
            return
        time.sleep(0.05)
    raise AssertionError(true)


def alive(process: int) -> bool:
    """Whether a process is there, and is no zombie."""
    state = Path(f"/proc/{process}/stat")
    return state.exists() and state.read_text().rpartition(")")[2].split()[0] != "Z"


@pytest.fixture
def waiting(command, tmp_path):
    """A step that waits: its client, and its process."""
    told = tmp_path / "process"
    client = subprocess.Popen(
        ["step", "wait", told], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    until(lambda: told.is_file() and told.read_text())
    yield client, int(told.read_text())
    client.kill()
    client.communicate()


def test_words_folder_environment_streams_and_status(command, tmp_path):
    (place := tmp_path / "a place").mkdir()
    ended = run("7", "two words", "", cwd=place, env=os.environ | {"MINE": "x=y"})
    assert (ended.returncode, ended.stderr) == (7, "aside\n")
    assert ended.stdout == f"True {place} x=y two words \n"


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGKILL, -9)]
)
def test_a_signal_to_the_client_ends_the_step(waiting, number, status):
    client, process = waiting
    client.send_signal(number)
    assert client.wait(30) == status
    until(lambda: not alive(process))


def test_a_step_that_is_killed_is_told(waiting):
    client, process = waiting
    os.kill(process, signal.SIGKILL)
    assert client.wait(30) == -signal.SIGKILL


def test_a_stopped_client_stops_the_step(waiting):
    client, process = waiting
    client.send_signal(signal.SIGTSTP)
    until(lambda: Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "T")
    client.send_signal(signal.SIGCONT)
    until(lambda: Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "S")


def test_steps_end_with_the_one_who_started_the_warm_process(command, waiting):
    command.communicate()  # its standard input ends, as when that process is killed
    assert waiting[0].wait(30) == 1
    until(lambda: not alive(waiting[1]))


def test_where_the_warm_process_was_killed_a_step_starts_as_ever(command):
    command.kill()
    command.wait()
    ended = run("3", "word")
    assert (ended.returncode, ended.stdout.split()[0], ended.stderr) == (3, "False", "aside\n")


def test_nothing_is_forked_of_sources_that_have_changed(tmp_path):
    held = warm.Warm(str(tmp_path))
    source = tmp_path / "module.py"
    source.touch()
    held.sources[str(source)] = warm._written(str(source))
    fresh = held._ready()
    source.unlink()
    assert not held._ready()
    for file in (held.selector, held.listening, held.loaded, held.load):
        file.close()
    assert fresh == (len(os.listdir("/proc/self/task")) == 1)


def test_a_client_that_is_gone_when_its_step_has_ended_harms_nobody(tmp_path):
    """Both are noticed at once: a job that was killed at its very end."""
    server, (client, other) = warm.Warm(str(tmp_path)), socket.socketpair()
    ended = subprocess.Popen(["true"])
    step = warm.Step(ended.pid, open(os.pidfd_open(ended.pid), "rb", 0), client)
    server.steps.append(step)
    server.selector.register(step.watched, selectors.EVENT_READ)
    server.selector.register(client, selectors.EVENT_READ)
    other.close()
    server._end(step)
    server._pass_on(step)
    assert not server.steps and client.fileno() == -1
    ended.returncode = 0  # it was waited for
    for held in (server.selector, server.listening, server.loaded, server.load):
        held.close()
