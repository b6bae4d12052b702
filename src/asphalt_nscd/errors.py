"""The exceptions a user is meant to read."""

from __future__ import annotations

from pathlib import Path


class InputError(Exception):
    """Input that cannot be used.

    The message is one sentence that names the file, the row or key, and the mend. The command
    line prints it alone, without a traceback, and exits with status 2.
    """


class DamagedFile(InputError):
    """A result file of ours that cannot be used any more, and can be made again."""

    def __init__(self, path: str | Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}; delete it and run the workflow again.")
        self.path, self.problem = Path(path), problem
