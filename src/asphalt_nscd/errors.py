"""The exceptions a user is meant to read."""

from __future__ import annotations

from pathlib import Path

LONGEST = 1000  # characters of a message


class InputError(Exception):
    """Input that cannot be used.

    The message is one sentence that names the file, the row or key, and the mend. The command
    line prints it alone, without a traceback, and exits with status 2. What it quotes from a file
    may hold anything: it stays one line, and of a length to be read.
    """

    def __init__(self, message: str) -> None:
        line = " ".join(str(message).split())
        super().__init__(line if len(line) <= LONGEST else f"{line[: LONGEST - 200]} ... {line[-200:]}")


class DamagedFile(InputError):
    """A result file of ours that cannot be used any more, and can be made again."""

    def __init__(self, path: str | Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}; delete it and run the workflow again.")
        self.path, self.problem = Path(path), problem
