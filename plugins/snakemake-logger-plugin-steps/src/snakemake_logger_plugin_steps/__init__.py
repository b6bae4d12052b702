"""What a run of the workflow says on a terminal or into a file: `logger: steps`.

On a terminal one display: how far, how long still, which steps are running. Elsewhere a line for each step that has
ended. Warnings and errors in both. Snakemake's own account, with every command, stands in `.snakemake/log`.
`snakemake-logger-plugin-rich` 0.5.1 names no steps in a file.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field
from logging import ERROR, WARNING, LogRecord
from typing import Any

from rich import progress
from rich.console import Console, Group
from rich.live import Live
from rich.text import Text
from snakemake.logging import ColorizingTextHandler
from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

__all__ = ["LogHandler"]

SAID = ("Nothing to be done", "Report: ")  # of what Snakemake says beside steps
# Of a step that failed, beside the line on it and the sentence that `onerror` in the Snakefile prints.
REPEATED = (
    "RuleException:\nCalledProcessError",
    "Exiting because a job",
    "WorkflowError:\nAt least one job did not",
)
MOST_SHOWN = 8  # running steps on a terminal


@dataclass
class Steps:
    """What is known of the jobs of a run by their numbers."""

    title: dict[int, str] = field(default_factory=dict)
    began: dict[int, float] = field(default_factory=dict)  # of those that run
    done: int = 0
    total: int = 0

    def end(self, job: int) -> tuple[str, float]:
        """Title of a job that has ended, and the seconds that it took."""
        self.done += 1
        now = time.monotonic()
        return self.title.pop(job, f"job {job}"), now - self.began.pop(job, now)


class LogHandler(LogHandlerBase):
    """Snakemake calls `emit` with each of its records, in a thread of its own."""

    # In place of Snakemake's own handler, which keeps the file.
    writes_to_stream = has_filter = has_formatter = True
    writes_to_file = needs_rulegraph = False

    def __post_init__(self) -> None:
        settings = self.common_settings
        stream = sys.stdout if settings.stdout else sys.stderr
        # a plan and a search for faults are for Snakemake's own words
        self._plain: ColorizingTextHandler | None = None
        hushed = {what.name for what in settings.quiet or []} - {"HOST"}
        if settings.dryrun or settings.verbose or settings.debug_dag or hushed:
            self._plain = ColorizingTextHandler(nocolor=settings.nocolor, stream=stream)
        self.console = Console(
            file=stream, no_color=settings.nocolor or None, highlight=False, soft_wrap=True
        )
        self.steps = Steps()
        text = progress.TextColumn
        columns = [text("steps"), progress.MofNCompleteColumn(), progress.BarColumn()]
        elapsed, left = progress.TimeElapsedColumn(), progress.TimeRemainingColumn()
        columns += [elapsed, text("elapsed,"), left, text("left")]
        self._progress = progress.Progress(*columns, console=self.console)
        self._bar = self._progress.add_task("", total=None)
        self._live: Live | None = None

    def emit(self, record: LogRecord) -> None:
        """One record."""
        try:
            if self._plain is not None:
                if self._plain_filter(record):
                    self._plain.emit(record)
                return
            self._take(getattr(record, "event", None), vars(record), record)
            self._show()
        except Exception:  # the run must not end by what is said about it
            self.handleError(record)

    def close(self) -> None:
        """The run has ended."""
        self._stop()
        super().close()

    def _take(self, event: LogEvent | None, said: dict[str, Any], record: LogRecord) -> None:
        steps = self.steps
        if event == LogEvent.JOB_INFO:
            steps.title[said["jobid"]] = said["rule_msg"] or said["rule_name"]
        elif event == LogEvent.JOB_STARTED:
            steps.began |= dict.fromkeys(_numbers(said["jobs"]), time.monotonic())
        elif event == LogEvent.JOB_FINISHED:
            title, seconds = steps.end(said["job_id"])
            if not self.console.is_terminal:
                total = f"/{steps.total}" if steps.total else ""
                self.console.print(f"{steps.done}{total} {title} ({seconds:.1f} s)", markup=False)
        elif event == LogEvent.RUN_INFO:
            steps.total = int((said.get("stats") or {}).get("total", 0))
        elif event == LogEvent.PROGRESS:
            steps.done, steps.total = said["done"], said["total"]
        elif event in (LogEvent.JOB_ERROR, LogEvent.GROUP_ERROR):
            job = said.get("jobid")
            steps.began.pop(job, None)
            title = steps.title.get(job) or f"rule {said.get('rule_name') or said.get('groupid')}"
            logs = ", ".join(map(str, said.get("log") or []))
            self.console.print(f"failed: {title}{'; see ' + logs if logs else ''}", markup=False, style="red")
        elif event is None or event == LogEvent.ERROR:
            text = record.getMessage()
            if (record.levelno >= WARNING and not text.startswith(REPEATED)) or text.startswith(SAID):
                style = "red" if record.levelno >= ERROR else "yellow" if record.levelno >= WARNING else None
                self.console.print(text, markup=False, style=style)

    def _show(self) -> None:
        """On a terminal, how far the run is."""
        steps = self.steps
        if not self.console.is_terminal or not steps.total:
            return
        if self._live is None and steps.began:
            self._live = Live(console=self.console, refresh_per_second=2, transient=True)
            self._live.start()
        if self._live is not None:
            self._progress.update(self._bar, completed=steps.done, total=steps.total)
            running = [steps.title.get(job, "") for job in steps.began]
            lines = [Text(f"  {title}", overflow="ellipsis", no_wrap=True) for title in running[:MOST_SHOWN]]
            if len(running) > MOST_SHOWN:
                lines.append(Text(f"  and {len(running) - MOST_SHOWN} more"))
            self._live.update(Group(self._progress, *lines))
            if steps.done >= steps.total:
                self._stop()

    def _stop(self) -> None:
        if self._live is not None:
            self._live.stop()
            self._live = None

    def _plain_filter(self, record: LogRecord) -> bool:
        """As Snakemake filters for itself."""
        from snakemake.logging import DefaultFilter, DefaultFormatter

        settings, plain = self.common_settings, self._plain
        if plain is not None and plain.formatter is None:
            quiet = settings.quiet or []
            asked = settings.debug_dag, settings.verbose, settings.dryrun, settings.printshellcmds
            plain.setFormatter(DefaultFormatter(quiet, settings.show_failed_logs))
            plain.addFilter(DefaultFilter(quiet, *asked))
        return plain is not None and bool(plain.filter(record))


def _numbers(jobs: Any) -> list[int]:
    return list(jobs) if isinstance(jobs, list | tuple | set) else [jobs]
