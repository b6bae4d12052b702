"""A finished study, copies of it, and what one may do to a run of it."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from workspace import Workspace

RESULTS = Path("results/smoke")
Run = subprocess.CompletedProcess[str]


class Study(Workspace):
    """The smoke study, run in a folder of its own as far as `targets`."""

    targets: tuple[str, ...] = ()

    def finish(self, *arguments: str) -> Run:
        return self.run("--cores", "2", *arguments, *self.targets)

    def copy(self, folder: Path) -> Study:
        """As it stands, with all times and records of Snakemake."""
        shutil.copytree(self.folder, folder, symlinks=True)
        other = self.at(folder)
        other.targets = self.targets
        return other

    @classmethod
    def at(cls, folder: Path) -> Study:
        """What stands in a folder already."""
        study = object.__new__(cls)
        study.folder = folder
        return study

    @property
    def results(self) -> Path:
        return self.folder / RESULTS

    def finish_alone(self, **options: Any) -> Run:
        """The same in a process of its own, with options of Popen."""
        return self.alone("--cores", "2", *self.targets, stdout=subprocess.PIPE, **options)

    def watched(self, look: Callable[[dict[str, int]], None], *arguments: str) -> Run:
        """A run; `look` is shown the processes of its jobs again and again, as `jobs` gives them."""
        with tempfile.TemporaryFile("w+") as said:
            process = self.start("--logger", "steps", "--cores", "2", *arguments, *self.targets, stderr=said)
            try:
                while process.poll() is None:
                    look(self.jobs())
                    time.sleep(0.02)
            finally:
                process.kill()
            said.seek(0)
            return Run(process.args, process.returncode, "", said.read())

    def killed(self, log: str, signum: int = signal.SIGKILL, delay: float = 0.2) -> Run:
        """A run in which the job that writes `log` gets a signal shortly after it began."""
        victims = Victims({log: log}, lambda log: delay, signum)
        met = self.watched(victims.look)
        if not victims.killed or met.returncode == 0:
            raise Missed(f"the job that writes {log} ended before it was killed")
        return met

    def jobs(self) -> dict[str, int]:
        """Jobs that run in this folder: the log, below `logs`, that a process writes, and its number."""
        found: dict[str, int] = {}
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                log = Path(os.readlink(entry / "fd/1"))
            except OSError:
                continue
            if log.is_relative_to(self.results / "logs"):
                name, number = str(log.relative_to(self.results / "logs")), int(entry.name)
                found[name] = min(number, found.get(name, number))  # the job, not what it started
        return found


class Victims:
    """One job of each rule gets a signal, once, `delay(log)` seconds after it was seen first.

    rules: of each log the rule that writes it; killed: of each rule whose job was met, the log of that job."""

    def __init__(
        self, rules: dict[str, str], delay: Callable[[str], float], signum: int = signal.SIGKILL
    ) -> None:
        self.rules, self.delay, self.signum = rules, delay, signum
        self.killed: dict[str, str] = {}
        self._chosen: dict[str, tuple[str, float]] = {}  # of each rule the log, and when

    def look(self, jobs: dict[str, int]) -> None:
        for log, number in jobs.items():
            rule = self.rules.get(log)
            if rule is None or rule in self.killed:
                continue
            if rule not in self._chosen:
                self._chosen[rule] = log, time.monotonic() + self.delay(log)
            chosen, when = self._chosen[rule]
            if chosen == log and time.monotonic() >= when:
                try:
                    os.kill(number, self.signum)
                except ProcessLookupError:
                    continue
                self.killed[rule] = log
        for rule, (log, _) in list(self._chosen.items()):
            if log not in jobs and rule not in self.killed:
                del self._chosen[rule]  # it was too quick; another job of this rule may come


class Missed(Exception):
    """The fault came too late to test anything."""


def smallest_files(size: int) -> Callable[[], None]:
    """No file may grow beyond `size` bytes."""
    return lambda: (
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
    )


def least_memory(size: int) -> Callable[[], None]:
    """No process may take more than `size` bytes of addresses."""
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))
