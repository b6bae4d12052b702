"""A process that outlives the server, and removes what was dropped when the server has ended, however it did."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from pathlib import Path

SECONDS = 20.0  # in which jobs that lost their server end


def watch(folder: Path) -> subprocess.Popen[bytes]:
    """Start the process; it ends when this one does, or closes its `stdin`."""
    command = [sys.executable, "-m", __name__, str(folder)]
    # A session of its own: no signal of the terminal reaches it.
    return subprocess.Popen(command, stdin=subprocess.PIPE, start_new_session=True)


def main(folder: str) -> None:
    """Wait for the end of the server, then remove the folder until no job writes into it any more."""
    sys.stdin.buffer.read()
    until = time.monotonic() + SECONDS
    while Path(folder).exists() and time.monotonic() < until:
        shutil.rmtree(folder, ignore_errors=True)
        time.sleep(0.1)


if __name__ == "__main__":
    main(sys.argv[1])
