"""Where the time goes: Snakemake's benchmark files summed by rule."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import CPU_TIME, InputError


def rule_times(benchmarks: Iterable[str | Path], folder: str | Path) -> pd.DataFrame:
    """One row for each rule, most time first.

    benchmarks: files in `folder`, rule.tsv for a single job, rule/.../*.tsv for many; those of jobs that
    were never timed may be absent. The log of a job, in `logs` beside `folder`, ends with its CPU time and memory;
    else they are what Snakemake saw of it. Columns: rule, jobs, wall_s (sum over jobs), cpu_s, longest_s (a single
    job), memory_MB (largest resident set), share_percent (of wall_s).
    """
    logs = Path(folder).parent / "logs"
    rows = []
    for path in map(Path, benchmarks):
        if not path.exists():
            continue
        job = _job(path)
        # RULE.tsv, or a folder RULE with a file for each job.
        rule = path.relative_to(folder).parts[0].removesuffix(".tsv")
        told = _told(logs / path.relative_to(folder).with_suffix(".log"))
        seen = _number(job["cpu_time"]), _number(job["max_rss"])
        rows.append((rule, _number(job["s"]), *(told or seen)))
    if not rows:
        raise InputError(f"{folder}: no benchmark files; run the workflow first.")
    jobs = pd.DataFrame(rows, columns=["rule", "s", "cpu", "memory"]).groupby("rule", as_index=False)
    table = jobs.agg(
        jobs=("s", "size"),
        wall_s=("s", "sum"),
        cpu_s=("cpu", "sum"),
        longest_s=("s", "max"),
        memory_MB=("memory", "max"),
    )
    table["share_percent"] = 100.0 * table["wall_s"] / table["wall_s"].sum()
    return table.sort_values("wall_s", ascending=False, ignore_index=True)


def elapsed(benchmarks: Iterable[str | Path]) -> float:
    """Seconds in which at least one of the jobs ran: a job ends when its file is written. Pauses do not count."""
    spans = sorted(
        (path.stat().st_mtime - float(_job(path)["s"]), path.stat().st_mtime)
        for path in map(Path, benchmarks)
        if path.exists()
    )
    total, end = 0.0, -float("inf")
    for first, last in spans:
        total += max(last - max(first, end), 0.0)
        end = max(end, last)
    return total


def _told(log: Path) -> list[float]:
    """CPU time [s] and memory [MB] at the end of a log; nothing where they are not there."""
    last = (
        log.read_text(encoding="utf-8", errors="replace").rstrip().rpartition("\n")[2]
        if log.is_file()
        else ""
    )
    return [*map(float, re.findall(r"[\d.]+", last))] if last.startswith(CPU_TIME) else []


def _job(path: Path) -> dict[str, str]:
    """What Snakemake measured; pandas would take a second for as many files as a study has."""
    with path.open(encoding="utf-8", newline="") as file:
        return next(csv.DictReader(file, delimiter="\t"))


def _number(text: str) -> float:
    """The number; NaN where a job was too short to be measured, for which Snakemake writes - or NA."""
    return float("nan") if text in ("-", "NA") else float(text)


def timing_summary(table: pd.DataFrame, elapsed_s: float) -> str:
    """The rules that take a twentieth of the time or more, the others in one line, the sum, and how long it took."""
    long = table["share_percent"] >= 5.0
    few = {"jobs": "sum", "wall_s": "sum", "memory_MB": "max", "share_percent": "sum"}
    shown = table[long].set_index("rule")[[*few]]
    for name, rules in (("all others", table[~long]), ("sum", table)):
        shown.loc[name] = rules.agg(few)
    shown.columns = ["jobs", "wall time, s", "memory, MB", "share, %"]
    grid = shown.rename_axis("rule").reset_index().to_markdown(index=False, floatfmt=".0f", missingval="")
    return f"{grid}\n\nJobs ran side by side, so that all this took {elapsed_s / 60.0:.1f} minutes.\n"
