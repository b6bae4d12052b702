"""What a fault is, and the files and sentences that most of them are about."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from faults.study import Run, Study

DEPOSIT_LOG = "deposit/s1.log"
DEPOSIT, MODEL, TEST = "deposits/s1.h5", "models/free/s1.h5", "tests/s1/T20/f10.h5"
EXCERPT = "models/free/s1.excerpt.h5"
ALL = "report.html"
# A file of results, and one that is made from it.
READ = {
    DEPOSIT: "specimens/s1.h5",
    "specimens/s1.h5": MODEL,
    MODEL: "time_steps.csv",  # tests read the excerpt
    EXCERPT: TEST,
    TEST: "simulations.csv",
    "laws/published/T20.json": TEST,
    "measured.csv": "laws/fitted/T20.json",
    "simulations.csv": "samples.csv",
    "samples.csv": "pages/samples.html",
    "pages/samples.html": ALL,
}

CORE = "error: .*: the compiled core was damaged; it was removed"
KILLED = "error: the job was killed, or the memory was used up; run the same"
SET_ASIDE = r"error: \S+: .*; it was set aside as \.\S+\.damaged, run the workflow again to make it anew\."


@dataclass(frozen=True)
class Fault:
    """disturb: does it, and returns the run that met it; said: what that run's last line must match, None where
    the run has to succeed in spite of it; target: the file of results that both runs are to make, all if empty."""

    name: str
    disturb: Callable[[Study], Run]
    said: str | None
    target: str = ALL


class Unable(Exception):
    """This machine cannot do it."""


def last_line(run: Run) -> str:
    """The last line that begins with `error: `, else all that was said."""
    lines = [line for line in run.stderr.splitlines() if re.match("error: ", line)]
    return lines[-1] if lines else run.stderr.strip()
