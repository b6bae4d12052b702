"""What every benchmark writes: one CSV row for each thing measured, peers that are absent included."""

from __future__ import annotations

import resource
import shutil
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import write_table

COLUMNS = ["topic", "case", "spheres", "time_step_s", "cpu_s", "memory_MB", "remark"]


def write_rows(output: str | Path, rows: Sequence[dict[str, object]]) -> None:
    """Rows with the columns above, those left out empty."""
    write_table(output, pd.DataFrame(list(rows), columns=COLUMNS))


def absent(topic: str, case: str, program: str) -> dict[str, object] | None:
    """The row of a peer whose program is not installed, None where it is."""
    if shutil.which(program):
        return None
    return {"topic": topic, "case": case, "remark": f"absent: no program {program}"}


def run(command: Sequence[str], folder: str | Path) -> tuple[float, float, str]:
    """(CPU time [s], peak memory [MB], standard output) of a program that runs in `folder`, one thread.

    A process measures one program only: the peak is that of all its children.
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {(done.stdout + done.stderr)[-2000:]}")
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, after.ru_maxrss / 1024.0, done.stdout


class Clock:
    """CPU time [s] since it was started, and peak memory [MB] of this process."""

    def __init__(self) -> None:
        self.began = time.process_time()

    def row(self) -> dict[str, float]:
        """The two columns of a row."""
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        return {"cpu_s": time.process_time() - self.began, "memory_MB": peak}
