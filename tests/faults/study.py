"""A finished study, copies of it, and what one may do to a run of it."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from workspace import Workspace

RESULTS = Path("results/smoke")


class Study(Workspace):
    """The smoke study, run in a folder of its own as far as `targets`."""

    targets: tuple[str, ...] = ()

    def finish(self, *arguments: str) -> subprocess.CompletedProcess[str]:
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

    def under(self, limit: Callable[[], None], *arguments: str) -> subprocess.CompletedProcess[str]:
        """A run whose processes have a limit (of `resource`)."""
        return subprocess.run(
            self.command("--cores", "2", *arguments, *self.targets), cwd=self.folder, capture_output=True, text=True,
            env=self.environment, preexec_fn=limit,
        )  # fmt: skip

    def killed(
        self, output: str, signum: int = signal.SIGKILL, delay: float = 0.2
    ) -> subprocess.CompletedProcess[str]:
        """A run in which the job that writes `output` gets a signal shortly after it began."""
        process = self.start("--cores", "2", *self.targets)
        victim = None
        while process.poll() is None and victim is None:
            victim = self.job(output)
            time.sleep(0.005)
        if victim is not None:
            time.sleep(delay)
            try:
                os.kill(victim, signum)
            except ProcessLookupError:
                victim = None
        _, said = process.communicate()
        if victim is None:
            raise Missed(f"the job that writes {output} ended before it was killed")
        return subprocess.CompletedProcess(process.args, process.returncode, "", said)

    def job(self, output: str) -> int | None:
        """Process that works on `output` in this folder, itself and not a shell around it."""
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                if os.readlink(entry / "cwd") != str(self.folder):
                    continue
            except OSError:
                continue
            told = any(word.endswith((b"asphalt-nscd", b"snakemake")) for word in words[:3])
            if told and output.encode() in b" ".join(words) and b"--cores" not in words:
                return int(entry.name)
        return None


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
