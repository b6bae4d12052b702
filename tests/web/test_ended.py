"""However `serve` ends, nothing of a laboratory's stays: no file, no process."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

pytest.importorskip("flask")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")]

ROOT = Path(__file__).parents[2]
MIX = ROOT / "data/ncat/N1-1_RH.csv"
SECONDS = 60.0


def post(address: str, content: bytes, kind: str) -> None:
    request = urllib.request.Request(address, content, {"Content-Type": kind}, method="POST")
    urllib.request.urlopen(request).read()


def descendants(parent: int) -> set[int]:
    """Processes whose chain of parents leads to one."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            pid, rest = int(stat.parent.name), stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        parents[pid] = int(rest[1])
    found = {parent}
    while more := {pid for pid, of in parents.items() if of in found} - found:
        found |= more
    return found


def until(gone) -> bool:
    end = time.monotonic() + SECONDS
    while not gone() and time.monotonic() < end:
        time.sleep(0.1)
    return gone()


@pytest.mark.parametrize("way", [signal.SIGINT, signal.SIGKILL])
def test_nothing_is_left(way, tmp_path):
    environment = os.environ | {"TMPDIR": str(tmp_path), "PYTHONUNBUFFERED": "1"}
    command = [sys.executable, "-m", "asphalt_nscd.cli", "serve", "--no-browser"]
    # A shell's background jobs ignore an interrupt, and so would what they start.
    attended = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment, **attended)
    token = re.search(r"http://\S+", server.stdout.readline()).group()
    desk = urllib.request.urlopen(token).geturl()
    head = '--x\r\nContent-Disposition: form-data; name="files"; filename="t.csv"\r\n\r\n'
    part = f"{head}{MIX.read_text()}\r\n--x--\r\n"
    post(f"{desk}files", part.encode(), "multipart/form-data; boundary=x")
    post(f"{desk}diagnose", b"{}", "application/json")
    running = descendants(server.pid)
    assert len(running) >= 3 and list(tmp_path.rglob("t.csv"))  # the server, its janitor, the job
    server.send_signal(way)
    server.wait(SECONDS)
    assert until(lambda: not any(tmp_path.iterdir()))
    assert until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in running))
