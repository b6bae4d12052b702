"""What Slurm and Snakemake take for themselves: cores held by jobs beside the time of the steps in them."""

from __future__ import annotations

import re
import subprocess
from datetime import datetime
from pathlib import Path

NOT_IN_JOBS = ("study.tsv", "timings.tsv")  # local rules, next to Snakemake


def cost(results: Path) -> dict[str, float]:
    """Of all jobs of this Slurm, which made these results: numbers by what they are."""
    said = subprocess.run(["scontrol", "show", "job"], capture_output=True, text=True, check=True).stdout
    timed = [path for path in (results / "benchmarks").rglob("*.tsv") if path.name not in NOT_IN_JOBS]
    return account(said, [float(path.read_text().splitlines()[-1].split("\t")[0]) for path in timed])


def account(said: str, steps: list[float]) -> dict[str, float]:
    """From what `scontrol show job` says and the seconds of each step.

    Of a job that was preempted the last run counts, of one that was killed the job in its place: the steps are
    those of these runs.
    """
    jobs = [dict(re.findall(r"(\w+)=(\S+)", block)) for block in said.split("\n\n") if "JobId" in block]
    done = [job for job in jobs if job["JobState"] == "COMPLETED"]
    held = sum(_seconds(job["StartTime"], job["EndTime"]) * int(job["NumCPUs"]) for job in done)
    waited = [_seconds(job["SubmitTime"], job["StartTime"]) for job in done if job["Restarts"] == "0"]
    return {
        "Slurm jobs": len(done),
        "steps in them": len(steps),
        "core seconds held by the jobs": round(held),
        "seconds of the steps in them": round(sum(steps)),
        "own cost, percent of what is held": round(100.0 * (held - sum(steps)) / held, 1),
        "own cost, core seconds a job": round((held - sum(steps)) / len(done), 1),
        "seconds in the queue, a job": round(sum(waited) / len(waited), 1),
        "jobs killed in mid-run, made again by Snakemake": sum(
            job["JobState"] == "CANCELLED" for job in jobs
        ),
        "jobs preempted in mid-run, made again by Slurm": sum(job["Restarts"] != "0" for job in jobs),
    }


def _seconds(first: str, last: str) -> float:
    return (datetime.fromisoformat(last) - datetime.fromisoformat(first)).total_seconds()
