"""SIGKILL in every rule: a study made from nothing, through which a job of each rule is killed half-way."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

from comparison import differences

from faults.ended import killed
from faults.fault import KILLED
from faults.judge import Judged, judge
from faults.study import RESULTS, Run, Study, Victims

KIND = "SIGKILL in each rule"


def kill_each_rule(finished: Study, folder: Path) -> list[Judged]:
    """Run after run goes as far as it can without the jobs killed in it, until no rule is left; then the results
    must be those of the undisturbed study. Rules whose jobs were too quick are killed one by one."""
    jobs = logs_and_outputs(finished)
    rules = {log: rule for log, (rule, _) in jobs.items()}
    study = Study(folder / "study")
    study.configure()
    judged: dict[str, Judged] = {}
    tried: set[str] = set()
    while True:
        victims = Victims({log: rule for log, rule in rules.items() if rule not in tried}, half(finished))
        met = study.watched(victims.look, "--keep-going")
        for rule, log in victims.killed.items():
            if log in met.stderr:  # else it had ended just before
                judged[rule] = Judged(KIND, f"SIGKILL in {rule}", *_told(met, log))
        tried |= victims.killed.keys()
        if not victims.killed:
            break
    different = [met.stderr[-300:]] if met.returncode else differences(finished.results, study.results)
    if different:
        judged = {rule: row.spoilt("; ".join(different)) for rule, row in judged.items()}
    for log, (rule, output) in jobs.items():
        if rule not in judged:
            judged[rule] = judge(KIND, killed(rule, output, log), finished, folder / "alone")
    return list(judged.values())


def logs_and_outputs(study: Study) -> dict[str, tuple[str, str]]:
    """Of each log below `logs` the rule whose job writes it, and the first file that this job makes."""
    listed = study.run("--cores", "1", "--summary").stdout
    rows = csv.DictReader([line for line in listed.splitlines() if "\t" in line], delimiter="\t")
    found: dict[str, tuple[str, str]] = {}
    for row in rows:
        log = Path(row["log-file(s)"])
        if log.is_relative_to(RESULTS / "logs"):
            output = str(Path(row["output_file"]).relative_to(RESULTS))
            found.setdefault(str(log.relative_to(RESULTS / "logs")), (row["rule"], output))
    return found


def half(finished: Study) -> Callable[[str], float]:
    """Half of the time, in seconds, that the job with this log took undisturbed; half a second where it was not
    noted under the same name."""

    def seconds(log: str) -> float:
        table = finished.results / "benchmarks" / Path(log).with_suffix(".tsv")
        if not table.is_file():
            return 0.5
        return 0.5 * float(table.read_text().splitlines()[1].split("\t")[0])

    return seconds


def _told(met: Run, log: str) -> tuple[str, str]:
    """Verdict and sentence."""
    sentences = [line for line in met.stderr.splitlines() if line.endswith(f"({RESULTS}/logs/{log})")]
    if "Traceback" in met.stderr:
        return "a traceback was printed", met.stderr[-300:]
    if not sentences or not sentences[-1].startswith(KILLED):
        return f"not told as {KILLED}", (sentences or [met.stderr[-300:]])[-1]
    return "passed", sentences[-1]
