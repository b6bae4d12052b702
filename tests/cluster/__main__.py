"""The smoke study here and through Slurm, with jobs killed and preempted in mid-run; equal bit for bit.

PYTHONPATH=tests python -m cluster     or     make cluster
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from datetime import datetime
from pathlib import Path

import pandas as pd
from comparison import differences

from asphalt_nscd.store import provenance, write_json, write_table
from cluster.node import slurm, why_not

ROOT = Path(__file__).parents[2]
RESULTS = Path("results/smoke")
OUTPUT = Path("results/cluster")
# squeue, for there is no accounting; and looked at more often than a real cluster would like.
ON_ONE_NODE = (
    "--profile", "profiles/slurm", "--slurm-no-account", "--slurm-status-command", "squeue",
    "--seconds-between-status-checks", "2", "--slurm-init-seconds-before-status-checks", "2", "--latency-wait", "5",
)  # fmt: skip
# What is done to the first job of a rule while it runs, and the rule.
DISTURBANCES = {"rule_deposit_": ("scancel",), "rule_tests_": ("scontrol", "requeue")}


def main() -> int:
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that what was started is stopped
    if reason := why_not():
        print(f"skipped: {reason}.")
        return 0
    folder = Path(tempfile.mkdtemp(prefix="cluster-"))
    try:
        here, there = (_workspace(folder / name) for name in ("here", "there"))
        if subprocess.run(_snakemake("--cores", "2"), cwd=here, stdout=subprocess.DEVNULL).returncode:
            return 1
        with slurm():
            done = _disturbed(there)
            rows = _cost(there)
        different = differences(here / RESULTS, there / RESULTS)
        rows |= {"disturbed in mid-run": done, "files of results that differ from a run here": len(different)}
        table = pd.DataFrame(rows.items(), columns=["what", "number"])
        write_table(OUTPUT / "cluster.csv", table)
        write_json(OUTPUT / "provenance.json", provenance())
        print(table.to_string(index=False))
        print("\n".join(different) or "All results are equal bit for bit.")
        return 1 if different or done < len(DISTURBANCES) else 0
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _workspace(folder: Path) -> Path:
    for name in ("config", "data", "profiles"):
        shutil.copytree(ROOT / name, folder / name)
    return folder


def _snakemake(*arguments: str) -> list[str]:
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    return [*words, "--configfile", "config/smoke.yaml", "--quiet", "all", *arguments]


def _disturbed(folder: Path) -> int:
    """Run the study through Slurm; the number of jobs that were killed or preempted while they ran."""
    waiting = dict(DISTURBANCES)
    with subprocess.Popen(_snakemake(*ON_ONE_NODE), cwd=folder) as process:
        try:
            while process.poll() is None:
                for number, comment in _running():
                    name = next((name for name in waiting if name in comment), None)
                    if name is not None:
                        time.sleep(3.0)  # into the middle of its work
                        subprocess.run([*waiting.pop(name), number], check=True)
                        print(f"{comment}: {' '.join(DISTURBANCES[name])}")
                time.sleep(0.5)
        finally:
            process.kill()
    if process.returncode:
        logs = [*folder.rglob(".snakemake/slurm_logs/**/*.log"), *folder.rglob(".snakemake/log/*.log")]
        print(*(f"{path}:\n{path.read_text(errors='replace')[-3000:]}" for path in logs), sep="\n")
        raise SystemExit(f"error: snakemake ended with {process.returncode}.")
    return len(DISTURBANCES) - len(waiting)


def _running() -> list[tuple[str, str]]:
    """Number and comment of jobs that run: the comment names rule or group."""
    listed = subprocess.run(
        ["squeue", "--noheader", "--states=RUNNING", "--format=%i %k"],
        capture_output=True,
        text=True,
        check=True,
    )
    return [(line.split()[0], line.partition(" ")[2]) for line in listed.stdout.splitlines()]


def _cost(folder: Path) -> dict[str, float]:
    """What Slurm took for itself: time in jobs beside that of the steps in them."""
    said = subprocess.run(["scontrol", "show", "job"], capture_output=True, text=True, check=True).stdout
    fields = [dict(re.findall(r"(\w+)=(\S+)", block)) for block in said.split("\n\n") if "JobId" in block]
    whole = [job for job in fields if job["JobState"] == "COMPLETED"]
    spent = sum(
        (datetime.fromisoformat(job["EndTime"]) - datetime.fromisoformat(job["StartTime"])).total_seconds()
        * int(job["NumCPUs"])
        for job in whole
    )
    waited = sum(
        (datetime.fromisoformat(job["StartTime"]) - datetime.fromisoformat(job["SubmitTime"])).total_seconds()
        for job in whole
    )
    benchmarks = list((folder / RESULTS / "benchmarks").rglob("*.tsv"))
    steps = sum(float(path.read_text().splitlines()[-1].split("\t")[0]) for path in benchmarks)
    return {
        "Slurm jobs": len(whole),
        "steps in them": len(benchmarks),
        "core seconds held by the jobs": round(spent),
        "seconds of the steps in them": round(steps),
        "seconds in the queue, a job": round(waited / len(whole), 1),
        "seconds of its own, a job": round((spent - steps) / len(whole), 1),
    }


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
