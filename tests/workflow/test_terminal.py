"""What a run says: a line a step into a file, one display on a terminal, one sentence where a step fails."""

from __future__ import annotations

import io
import logging
from types import SimpleNamespace

import pytest
from rich.console import Console
from snakemake.settings.types import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

from snakemake_logger_plugin_steps import LogHandler

pytestmark = pytest.mark.slow

SETTINGS = {
    "stdout": False,
    "nocolor": True,
    "dryrun": False,
    "verbose": False,
    "debug_dag": False,
    "quiet": [],
}


@pytest.fixture
def handler(monkeypatch):
    """A handler that writes into a text."""

    def make(terminal: bool, **settings: object) -> tuple[LogHandler, io.StringIO]:
        monkeypatch.setattr("sys.stderr", text := io.StringIO())
        made = LogHandler.__new__(LogHandler)
        logging.Handler.__init__(made)
        made.common_settings = SimpleNamespace(**SETTINGS | settings)
        made.__post_init__()
        made.console = Console(file=text, force_terminal=terminal, width=80, highlight=False)
        made._progress.live.console = made.console
        return made, text

    return make


def tell(handler, event, message="", level=logging.INFO, **said):
    record = logging.LogRecord("snakemake", level, "", 0, message, None, None)
    vars(record).update(said, event=event)
    handler.emit(record)


def started(handler):
    tell(handler, LogEvent.JOB_INFO, jobid=3, rule_msg="Test sample s1", rule_name="simulate")
    tell(handler, LogEvent.JOB_INFO, jobid=4, rule_msg=None, rule_name="all")
    tell(handler, LogEvent.JOB_STARTED, jobs=[3])
    tell(handler, LogEvent.PROGRESS, done=1, total=9)


def test_a_line_a_step_into_a_file(handler):
    told, text = handler(terminal=False)
    tell(told, None, "Building DAG of jobs...")
    started(told)
    tell(told, LogEvent.SHELLCMD, "asphalt-nscd simulate")
    tell(told, LogEvent.JOB_FINISHED, job_id=3)
    tell(told, LogEvent.JOB_FINISHED, job_id=4)
    tell(told, None, "the disk is nearly full", logging.WARNING)
    tell(told, None, "Report: here")
    lines = text.getvalue().splitlines()
    assert lines == [
        "2/9 Test sample s1 (0.0 s)",
        "3/9 all (0.0 s)",
        "the disk is nearly full",
        "Report: here",
    ]


def test_a_failed_step_is_one_line_and_its_log(handler):
    told, text = handler(terminal=False)
    started(told)
    tell(told, None, "RuleException:\nCalledProcessError in file x", logging.ERROR)
    tell(told, LogEvent.JOB_ERROR, "", logging.ERROR, jobid=3, rule_name="simulate", log=["logs/a.log"])
    tell(told, None, "Exiting because a job execution failed.", logging.ERROR)
    tell(told, LogEvent.ERROR, "the rule book is torn", logging.ERROR)
    assert text.getvalue().splitlines() == [
        "failed: Test sample s1; see logs/a.log",
        "the rule book is torn",
    ]


def test_a_plan_is_told_by_snakemake_itself(handler):
    told, text = handler(terminal=False, dryrun=True, printshellcmds=True, show_failed_logs=True)
    tell(told, None, "Building DAG of jobs...")
    assert "Building DAG" in text.getvalue()
    hushed, text = handler(terminal=False, quiet=[Quietness.ALL], printshellcmds=True, show_failed_logs=True)
    started(hushed)
    assert text.getvalue() == ""
