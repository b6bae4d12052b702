"""A study here and through Slurm, with one job killed and one preempted in mid-run; equal bit for bit.

make cluster                                                                  the smoke study
PYTHONPATH=trials:src python -m cluster --configfile config/paper.yaml         another
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd
import yaml
from comparison import differences, results

from asphalt_nscd.files.store import provenance, write_json, write_table
from cluster.cost import cost
from cluster.node import slurm, why_not

ROOT = Path(__file__).parents[2]
OUTPUT = Path("results/cluster")
# squeue, for there is no accounting; and looked at more often than a real cluster would like.
ON_ONE_NODE = (
    "--profile", "profiles/slurm", "--slurm-chunks-no-account", "--slurm-chunks-status-command", "squeue",
    "--seconds-between-status-checks", "2", "--slurm-chunks-init-seconds-before-status-checks", "2",
    "--latency-wait", "5",
)  # fmt: skip
# What is done to the first chunk of a group while a step of it runs.
DISTURBANCES = {"rule_specimen": ("scancel",), "rule_tests": ("scontrol", "requeue")}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--configfile", type=Path, default=Path("config/smoke.yaml"), help="the study")
    parser.add_argument(
        "--finished", type=Path, help="its results, where it has been run by this code before"
    )
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that what was started is stopped
    if reason := why_not():
        print(f"skipped: {reason}.")
        return 0
    name = yaml.safe_load(given.configfile.read_text(encoding="utf-8"))["study"]
    folder = Path(tempfile.mkdtemp(prefix="cluster-"))
    different: list[str] = []
    try:
        here = given.finished or _run_here(_workspace(folder / "here"), given.configfile) / "results" / name
        there = _workspace(folder / "there")
        with slurm():
            began = time.monotonic()
            _disturbed(there, given.configfile)
            rows = cost(there / "results" / name)
        rows["seconds from first to last"] = round(time.monotonic() - began)
        different = differences(here, there / "results" / name)
        rows["files of results compared"] = len(results(there / "results" / name))
        rows["files that differ from a run without Slurm"] = len(different)
        table = pd.DataFrame(rows.items(), columns=["what", name])
        write_table(OUTPUT / "cluster.csv", table)
        write_json(OUTPUT / "provenance.json", provenance())
        print(table.to_string(index=False))
        if different:
            print(*different, f"To look at them: {folder}", sep="\n")
            return 1
        print("All results are equal bit for bit.")
        return 0
    finally:
        if not different:
            shutil.rmtree(folder, ignore_errors=True)


def _run_here(folder: Path, config: Path) -> Path:
    if subprocess.run(_snakemake(config, "--cores", "2"), cwd=folder, stdout=subprocess.DEVNULL).returncode:
        raise SystemExit("error: the study failed without Slurm.")
    return folder


def _workspace(folder: Path) -> Path:
    for name in ("config", "data", "profiles"):
        shutil.copytree(ROOT / name, folder / name)
    return folder


def _snakemake(config: Path, *arguments: str) -> list[str]:
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    return [*words, "--configfile", str(config), "--quiet", "all", *arguments]


def _disturbed(folder: Path, config: Path) -> None:
    """Run the study through Slurm, kill one job and preempt another while they run."""
    waiting = dict(DISTURBANCES)
    with subprocess.Popen(_snakemake(config, *ON_ONE_NODE), cwd=folder) as process:
        try:
            while process.poll() is None:
                for number, comment in _running():
                    group = next((group for group in waiting if comment.startswith(group)), None)
                    if group is not None and _at_work(number):
                        time.sleep(1.0)
                        subprocess.run([*waiting.pop(group), number], check=True)
                        print(f"{' '.join(DISTURBANCES[group])}: job {number}, {comment}", flush=True)
                time.sleep(0.5)
        finally:
            process.kill()
    if process.returncode:
        logs = [*folder.rglob(".snakemake/slurm_logs/**/*.log"), *folder.rglob(".snakemake/log/*.log")]
        print(*(f"{path}:\n{path.read_text(errors='replace')[-3000:]}" for path in logs), sep="\n")
        raise SystemExit(f"error: snakemake ended with {process.returncode}.")
    if waiting:
        raise SystemExit(f"error: no job of {', '.join(waiting)} was met at work.")


def _running() -> list[tuple[str, str]]:
    """Number and comment of jobs that run: the comment names the group."""
    listed = subprocess.run(
        ["squeue", "--noheader", "--states=RUNNING", "--format=%i %k"],
        capture_output=True,
        text=True,
        check=True,
    )
    return [(line.split()[0], line.partition(" ")[2]) for line in listed.stdout.splitlines()]


def _at_work(number: str) -> bool:
    """Whether a step of that Slurm job computes."""
    for place in Path("/proc").glob("[0-9]*"):
        try:
            command, environment = (place / "cmdline").read_bytes(), (place / "environ").read_bytes()
        except OSError:
            continue  # it has ended
        if b"/asphalt-nscd\0" in command and f"SLURM_JOB_ID={number}".encode() in environment.split(b"\0"):
            return True
    return False


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
