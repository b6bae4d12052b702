"""What went wrong in a run of the workflow, a sentence for each failed job."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

_FAILED = re.compile(r"^ +log: (.+) \(check log file", re.MULTILINE)  # as Snakemake puts it
_DIED = re.compile(r"died with <Signals\.\w+: \d+>\.\n(?:(?! +log: ).*\n)* +log: (.+) \(check log file")
_SET_ASIDE = re.compile(r"error: (.+?): .*; it was set aside as ")
_PROGRESS = re.compile(r"\d+%")
KILLED = "error: the job was killed, or the memory was used up; run the same command again."
INTERRUPTED = "error: interrupted; nothing half-written is left."


def failures(snakemake_logs: Iterable[str | Path]) -> list[str]:
    """The last word of each failed job, with the log that holds it in brackets.

    `snakemake_logs` are of one run of the workflow. A job that could not say anything was ended from outside; its log
    is made to say so. Of a damaged file that one job set aside, others at the same time say that it is not there, which
    is left out.
    """
    run = "\n".join(map(_text, snakemake_logs))
    said, died = [], {*map(Path, _DIED.findall(run))}
    for path in map(Path, dict.fromkeys(_FAILED.findall(run))):
        text = _text(path).rstrip()
        last = re.split(r"[\r\n]", text)[-1]
        if last == "KeyboardInterrupt":  # while it was still loading
            last = INTERRUPTED
        # A job that was killed leaves no last word of its own, or what it had done; other programs say no `error:`.
        elif not last or _PROGRESS.search(last) or (path in died and not last.startswith("error: ")):
            last = KILLED
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("a", encoding="utf-8") as file:
                file.write(f"\n{KILLED}\n")
        elif not last.startswith("error: ") and "Traceback" not in text:
            last = f"error: {last}"
        said.append(f"{last} ({path})")
    aside = {found[1] for sentence in said if (found := _SET_ASIDE.match(sentence))}
    # Jobs that wait for a file set aside fail too, and say nothing new.
    missing = tuple(f"error: {path}: no such file" for path in aside)
    return [sentence for sentence in said if not sentence.startswith(missing)]


def _text(path: str | Path) -> str:
    path = Path(path)
    return path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
