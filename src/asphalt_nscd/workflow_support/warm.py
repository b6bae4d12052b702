"""A warm process, which has loaded what steps need and forks itself for each: most steps load longer than they compute.

It serves one run of Snakemake on Linux and runs a Python script, the installed command. What one step has loaded is
there for the next. `warm_client` hands a step over; a step whose sources were edited during the run, or that finds no
warm process, starts as ever.
"""

from __future__ import annotations

import atexit
import gc
import os
import runpy
import selectors
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import IO, Any, NamedTuple

ADDRESS = "socket"
LONGEST = 2**18  # bytes, of the names of the modules that a step has loaded
PACKAGE = str(Path(__file__).resolve().parents[1])


def start(command: str) -> subprocess.Popen[bytes] | None:
    """Start a warm process that ends with this one; the path then leads to the client in place of `command`."""
    if sys.platform != "linux":
        return None
    folder = Path(tempfile.mkdtemp(prefix="asphalt-nscd-"))  # which no other user may enter
    client = Path(__file__).with_name("warm_client.py")
    words = [sys.executable, "-I", "-S", client, folder / ADDRESS, command]
    script = folder / Path(command).name
    script.write_text(f'#!/bin/sh\nexec {shlex.join(map(str, words))} "$@"\n')
    script.chmod(0o700)
    # In a process group of its own: what a terminal sends reaches a step once, by its client. Its standard input ends
    # when this process does, however that ends.
    served = [sys.executable, "-P", "-m", __name__, str(folder)]
    warm = subprocess.Popen(served, stdin=subprocess.PIPE, process_group=0)
    atexit.register(warm.communicate)
    os.environ["PATH"] = f"{folder}{os.pathsep}{os.environ['PATH']}"
    return warm


class Step(NamedTuple):
    """A fork, `watched` by a descriptor of its process, and the client that waits for it."""

    process: int
    watched: IO[bytes]
    client: socket.socket

    def send(self, number: int) -> None:
        """Send a signal, unless it has ended."""
        with suppress(OSError, ValueError):
            signal.pidfd_send_signal(self.watched.fileno(), number)


class Warm:
    """The warm process whose address is in a folder."""

    def __init__(self, folder: str) -> None:
        self.words: list[str] | None = None  # of the step that this fork has become; [] at the end
        self.steps: list[Step] = []
        self.sources: dict[str, int | None] = {}  # when each was written
        self.selector = selectors.DefaultSelector()
        self.listening = socket.socket(socket.AF_UNIX)
        self.listening.bind(os.path.join(folder, ADDRESS))
        self.listening.listen(100)
        self.loaded, self.load = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)

    def serve(self) -> list[str]:
        """Fork for each client; gives the words of a step in its fork, none where standard input has ended."""
        self._watch(sys.stdin, self._stop)
        self._watch(self.listening, self._begin)
        self._watch(self.loaded, self._load)
        while self.words is None:
            for key, _ in self.selector.select():
                if self.words is None:
                    key.data()
        return self.words

    def _watch(self, file: Any, act: Callable[[], None]) -> None:
        self.selector.register(file, selectors.EVENT_READ, act)

    def _stop(self) -> None:
        self.words = []
        for step in self.steps:
            step.send(signal.SIGTERM)

    def _load(self) -> None:
        """Import what a step has imported, in its order."""
        for name in self.loaded.recv(LONGEST).decode().split():
            with suppress(Exception):  # some names are of no module
                import_module(name)
        gc.collect()
        gc.freeze()  # a fork shares what nobody looks at
        for module in [*sys.modules.values()]:
            file = str(getattr(module, "__file__", None))
            if file.startswith(PACKAGE) and file not in self.sources:
                self.sources[file] = _written(file)

    def _ready(self) -> bool:
        """Whether a fork is as good as a start: sources as they were loaded, and no thread, which a fork would lose."""
        fresh = all(_written(file) == time for file, time in self.sources.items())
        return fresh and len(os.listdir("/proc/self/task")) == 1

    def _begin(self) -> None:
        """Fork for a client that has come, or leave the step to it."""
        client, process, files = self.listening.accept()[0], None, list[int]()
        with suppress(OSError):
            # as `warm_client` sends it: length of the request, three standard files, request
            size, files, *_ = socket.recv_fds(client, 4, 3)
            request = client.recv(int.from_bytes(size), socket.MSG_WAITALL)
            process = os.fork() if files and self._ready() else None
        if process == 0:
            client.close()
            self._become(request, files)
        elif process:
            step = Step(process, open(os.pidfd_open(process), "rb", 0), client)
            self.steps.append(step)
            self._watch(step.watched, partial(self._end, step))
            self._watch(client, partial(self._pass_on, step))
            with suppress(OSError):
                client.send(b"+")
        else:
            client.close()
        for file in files:
            os.close(file)

    def _become(self, request: bytes, files: list[int]) -> None:
        """Be the step of a request: its words, folder, environment and standard files."""
        for held in (
            self.selector,
            self.listening,
            self.loaded,
            *(file for step in self.steps for file in step[1:]),
        ):
            held.close()
        folder, count, *told = os.fsdecode(request).split("\0")
        os.chdir(folder)
        for name, _, value in (variable.partition("=") for variable in told[int(count) :]):
            os.environ[name] = value
        for number, file in enumerate(files):
            os.dup2(file, number)
        sys.stdin, sys.stdout = open(0, closefd=False), open(1, "w", closefd=False)
        sys.stderr = open(2, "w", buffering=1, errors="backslashreplace", closefd=False)
        self.words = told[: int(count)]

    def _pass_on(self, step: Step) -> None:
        """Send a step the signals that its client has got; kill it where the client was killed."""
        if step not in self.steps:  # both ended at one moment, and `_end` came first
            return
        with suppress(OSError):
            if numbers := step.client.recv(16):
                for number in numbers:
                    step.send(number)
                return
        self.selector.unregister(step.client)
        step.send(signal.SIGKILL)

    def _end(self, step: Step) -> None:
        """Tell a client how its step has ended."""
        ended = os.waitstatus_to_exitcode(os.waitpid(step.process, 0)[1])
        with suppress(OSError):
            step.client.send(ended.to_bytes(4, signed=True))
        self.steps.remove(step)
        for file in (step.watched, step.client):
            with suppress(KeyError):  # of a client that was killed
                self.selector.unregister(file)
            file.close()


def _written(file: str) -> int | None:
    """When a file was written; none where it is gone."""
    with suppress(OSError):
        return os.stat(file).st_mtime_ns
    return None


def main(folder: str) -> None:
    """Serve; in a fork, run its step."""
    status = 0

    def leave() -> None:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)  # else Python would touch, and so copy, all that it has loaded

    atexit.register(leave)  # before all others, so that it is called after them
    warm = Warm(folder)
    sys.argv = warm.serve()
    if not sys.argv:
        shutil.rmtree(folder)
        return
    known = {*sys.modules}
    status = 1  # stays unless the step ends by sys.exit, as the installed command always does
    try:
        runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else bool(end.code)
        new = [name for name in sys.modules if name not in known]
        if new and not status:
            with suppress(OSError):  # more than a message holds
                warm.load.send(" ".join(new).encode())
        raise


if __name__ == "__main__":
    main(sys.argv[1])
