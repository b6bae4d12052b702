from __future__ import annotations

import pytest

from asphalt_nscd.workflow_support.failures import INTERRUPTED, KILLED, failures

RUN = """\
Error in rule reduce:
    output: results/a/measured.csv
    log: {0} (check log file(s) for error details)
    shell:
        asphalt-nscd reduce mine.csv > {0} 2>&1
Error in rule reduce:
    log: {0} (check log file(s) for error details)
"""


@pytest.mark.parametrize(
    ("written", "sentence"),
    [
        ("pouring: 50%\rpouring: 51%\nerror: m.csv: row 3: no.\n", "error: m.csv: row 3: no."),
        ("Traceback (most recent call last):\n  File x\nValueError: why\n", "ValueError: why"),
        ("Building DAG\nPackage pygments must be installed.\n", "error: Package pygments must be installed."),
        ("Traceback (most recent call last):\n  File x\nKeyboardInterrupt\n", INTERRUPTED),
        ("pouring: 50%|#####     |\rpouring: 51%|#####     |", KILLED),
        ("", KILLED),
        (None, KILLED),
    ],
)
def test_last_word_of_a_failed_job(tmp_path, written, sentence):
    (run := tmp_path / "run.log").write_text(RUN.format(job := tmp_path / "logs/reduce.log"))
    if written is not None:
        job.parent.mkdir()
        job.write_text(written)
    assert failures([run]) == failures([run]) == [f"{sentence} ({job})"]
    kept = job.read_text()
    assert kept.startswith((written or "").replace("\r", "\n")) and kept.count(KILLED) == (sentence == KILLED)


DIED = """\
RuleException:
CalledProcessError in file "rules/report.smk", line 70:
Command 'exec  asphalt-nscd reduce mine.csv' died with <Signals.SIGKILL: 9>.
[Sun Nov 29 07:00:04 2026]
"""


def test_what_a_killed_job_had_done_is_no_last_word(tmp_path):
    """But its own sentence is, and other jobs are not taken for killed."""
    words = {
        "one": "CPU time: 0.50 s, memory: 160 MB",
        "two": "error: it was stopped.",
        "three": "Building DAG",
        "four": "Traceback (most recent call last):\nKeyboardInterrupt",
    }
    for name, word in words.items():
        (tmp_path / name).write_text(f"{word}\n")
    (run := tmp_path / "run.log").write_text(
        "".join(DIED * (name != "three") + RUN.format(tmp_path / name) for name in words)
    )
    said = (KILLED, words["two"], "error: Building DAG", INTERRUPTED)
    assert failures([run]) == [f"{one} ({tmp_path / name})" for one, name in zip(said, words, strict=True)]


def test_run_without_a_failed_job_or_without_a_log(tmp_path):
    (run := tmp_path / "run.log").write_text("WorkflowError: no rule\n")
    assert failures([run]) == failures([]) == failures([tmp_path / "none.log"]) == []


def test_a_file_that_one_job_set_aside_is_not_said_to_be_missing_by_another(tmp_path):
    words = {
        "one": "error: results/a/m.h5: damaged; it was set aside as .m.h5.damaged, run the workflow again.",
        "two": "error: results/a/m.h5: no such file; run the rule that makes it, or check the path.",
        "three": "error: mine.csv: no such file; check the path.",
    }
    for name, sentence in words.items():
        (tmp_path / name).write_text(sentence + "\n")
    run = tmp_path / "run.log"
    run.write_text("".join(RUN.format(tmp_path / name) for name in words))
    assert failures([run]) == [f"{words[name]} ({tmp_path / name})" for name in ("one", "three")]
