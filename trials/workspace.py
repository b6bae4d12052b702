"""A folder in which the repository's workflow runs, as a user meets it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from forks import forked

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Plan:
    """Number of jobs of each rule, and all that a dry run says."""

    jobs: dict[str, int]
    lines: list[str]

    def commands(self, step: str) -> list[str]:
        """Command lines of a step."""
        return [line for line in self.lines if f"asphalt-nscd {step} " in line]


class Workspace:
    """A folder of its own in which the repository's Snakefile runs."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in ("config", "data", "profiles"):
            shutil.copytree(ROOT / name, folder / name)

    def configure(self, **changes: object) -> Path:
        """The smoke study with changes, as `study.yaml`; a change to None takes the key away."""
        study = yaml.safe_load((ROOT / "config/smoke.yaml").read_text()) | changes
        path = self.folder / "study.yaml"
        path.write_text(yaml.safe_dump({key: value for key, value in study.items() if value is not None}))
        return path

    def measure(self) -> dict[str, str]:
        """Measurements of one's own for the smoke study, in `mine.csv`."""
        rows = [f"1,{temperature},{frequency},9000,20" for temperature in (0, 20) for frequency in (3, 10)]
        header = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg"
        (self.folder / "mine.csv").write_text("\n".join([header, *rows]) + "\n")
        return {"table": "mine.csv"}

    def command(self, *arguments: str) -> list[str]:
        snakemake = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
        return [*snakemake, *arguments, "--configfile", "study.yaml"]

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """What `python -m snakemake` does and says, in a fork; `start` really starts it."""
        return forked("snakemake.cli:main", self.command(*arguments)[3:], self.folder, self.environment)

    def start(self, *arguments: str, **options: Any) -> subprocess.Popen[str]:
        """A run in a process of its own, with options of Popen; it says nothing but errors."""
        usual = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "env": self.environment}
        return subprocess.Popen(self.command(*arguments), cwd=self.folder, text=True, **usual | options)

    def alone(self, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
        """A run in a process of its own, to its end."""
        with self.start(*arguments, **options) as process:
            out, error = process.communicate()
        return subprocess.CompletedProcess(process.args, process.returncode, out or "", error or "")

    def planned(self, *arguments: str) -> dict[str, int]:
        """Number of jobs of each rule that a dry run announces."""
        return self.plan(*arguments, "--quiet", "rules").jobs

    def plan(self, *arguments: str) -> Plan:
        """What a dry run announces."""
        done = self.run(*arguments, "--dry-run", "--printshellcmds")
        assert done.returncode == 0, done.stderr
        lines = (done.stdout + done.stderr).splitlines()
        if "Job stats:" not in lines:
            return Plan({}, lines)
        table = lines[lines.index("Job stats:") + 3 :]
        rows = (line.split() for line in table[: next(i for i, line in enumerate(table) if "total" in line)])
        return Plan({rule: int(count) for rule, count in rows}, lines)

    @property
    def environment(self) -> dict[str, str]:
        return {name: value for name, value in os.environ.items() if not name.startswith("SNAKEMAKE")}
