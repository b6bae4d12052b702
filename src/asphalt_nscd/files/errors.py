"""The exceptions a user is meant to read."""

from __future__ import annotations

import os
from pathlib import Path

LONGEST = 1000  # characters of a message

# Set by the workflow: a step must not outlive a killed Snakemake, which would run it a second time, and
# a damaged result is set aside.
WITHIN_WORKFLOW = "ASPHALT_NSCD_WITHIN_WORKFLOW"
CPU_TIME = "CPU time: "  # begins the last line of the log of a job, with what it took
# Where the workflow, run at the top of the repository, puts what it makes, and what of it is committed.
RESULTS, PUBLISHED = "results", "published"


class InputError(Exception):
    r"""Input that cannot be used.

    The message is one sentence that names the file, the row or key, and the mend. The command line prints it
    alone, without a traceback, and exits with status 2.

    Parameters
    ----------
    message : str
        What it quotes from a file may hold anything: it stays one line, and of a length to be read.

    Examples
    --------
    >>> raise InputError("mix.csv, line 3: E_MPa = -5;\n give a modulus greater than zero.")
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: mix.csv, line 3: E_MPa = -5; give a modulus greater than zero.
    """

    def __init__(self, message: str) -> None:
        line = " ".join(str(message).split())
        # The end stays, for it says how to mend it.
        super().__init__(line if len(line) <= LONGEST else f"{line[: LONGEST - 200]} ... {line[-200:]}")


class DamagedFile(InputError):
    """A result file of ours that cannot be used any more, and can be made again."""

    def __init__(self, path: str | Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}; delete it and run the workflow again.")
        self.path, self.problem = Path(path), problem


def is_result(path: str | Path) -> bool:
    """Whether a step of the workflow is running, and this is a file that a rule makes."""
    parts = Path(path).parts
    return bool(os.environ.get(WITHIN_WORKFLOW)) and parts[:1] == (RESULTS,) and parts[1:2] != (PUBLISHED,)


def unreadable(path: str | Path, problem: str, mend: str) -> InputError:
    """What to raise for a file that cannot be read: a user's to mend, or a result of the workflow to be made again."""
    return DamagedFile(path, problem) if is_result(path) else InputError(f"{path}: {problem}; {mend}.")
