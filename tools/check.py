"""Are the published results those that this repository makes? What takes minutes is made again and compared.

    make check

The workflow runs in a folder of its own on the published tables: measurements, laws, tables and the diagnosis are
made again by their own rules; what stands on the full simulations (`simulations.csv` and the like) is taken as
published. Then the checksums of all that is published. The first difference of each file is named.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.reporting.publish import altered

ROOT = Path(__file__).resolve().parents[1]
# Files made again, their relative tolerance: rounding differs between processors, and minimisers stop on it.
REDONE = {
    "measured.csv": 1e-6,
    "table2.csv": 1e-9,
    "table3.csv": 1e-5,
    "table4.csv": 1e-6,
    "ladder.csv": 1e-4,
    "diagnosis/diagnosis.json": 1e-3,
    "diagnosis/residuals.csv": 1e-3,
    "diagnosis/law.json": 1e-3,
    "families.csv": 1e-3,
}
RULES = (
    "reconstruct", "reduce", "published_law", "fit", "table2", "table3", "table4", "diagnose", "ladder",
    "draw_family", "reduce_family", "diagnose_family", "families",
)  # fmt: skip
PUBLISHED = (
    *"attack benchmark calls cluster excess fall fatigue faults forecast fuzz intervals layouts mapping".split(),
    *"measured mutants paper ramp rigs verification".split(),
)
VOLATILE = ("provenance",)  # of a run, not of its result
TAKEN = ("simulations.csv", "likely.csv", "facets.csv", "extended.csv")  # of full simulations


def main(published: Path) -> int:
    with tempfile.TemporaryDirectory() as folder:
        found = [*_made_again(published, Path(folder)), *_checksums(published.parent)]
    well = f"{published}: {len(REDONE)} files made again are as published; all checksums hold."
    print("\n".join(found) or well)
    return 1 if found else 0


def _made_again(published: Path, folder: Path) -> list[str]:
    results = folder / "results/paper"
    for name in ("config", "data", "profiles"):
        shutil.copytree(ROOT / name, folder / name)
    for name in TAKEN:
        results.mkdir(parents=True, exist_ok=True)
        shutil.copy(published / name, results / name)
    specimen = results / "diagnosis/specimens/s1.h5"
    specimen.parent.mkdir(parents=True)
    shutil.copy(ROOT / "src/asphalt_nscd/diagnosis/simulation/specimen.h5", specimen)
    targets = [f"results/paper/{name}" for name in REDONE]
    command = [
        sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile"), "--cores", "all",
        "--configfile", "config/paper.yaml", "--quiet", "all", "--allowed-rules", *RULES, "--", *targets,
    ]  # fmt: skip
    environment = {name: value for name, value in os.environ.items() if not name.startswith("SNAKEMAKE")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        return [f"the workflow failed:\n{done.stderr[-3000:]}"]
    differences = (first_difference(published / name, results / name, REDONE[name]) for name in REDONE)
    return [difference for difference in differences if difference]


def first_difference(published: Path, redone: Path, tolerance: float) -> str | None:
    """Where two tables or JSON files first differ by more than a relative tolerance; None if nowhere."""
    if not redone.is_file():
        return f"{published}: was not made again"
    before, after = (dict(_numbers(path)) for path in (published, redone))
    for place in [*before, *(place for place in after if place not in before)]:
        old, new = before.get(place, "nothing"), after.get(place, "nothing")
        # Absolute too: a zero may come out as 1e-17 on another processor.
        both = isinstance(old, float) and isinstance(new, float)
        if old != new and not (both and math.isclose(old, new, rel_tol=tolerance, abs_tol=1e-12)):
            return f"{published}: {place} is {old}, made again {new}"
    return None


def _numbers(path: Path) -> Iterator[tuple[str, Any]]:
    """Each value of a file, by its place."""
    if path.suffix == ".json":
        yield from _leaves(json.loads(path.read_text(encoding="utf-8")), "")
        return
    for name, column in pd.read_csv(path, dtype=str, keep_default_na=False).items():
        for row, text in enumerate(column):
            number = pd.to_numeric(text, errors="coerce")
            yield f"{name} in line {row + 2}", text if pd.isna(number) else float(number)


def _leaves(content: Any, place: str) -> Iterator[tuple[str, Any]]:
    if isinstance(content, dict | list):
        for key, item in content.items() if isinstance(content, dict) else enumerate(content):
            if key not in VOLATILE:
                yield from _leaves(item, f"{place}.{key}".lstrip("."))
    else:
        # 1 and 1.0 are one number, whichever of the two JSON has.
        yield place, float(content) if isinstance(content, int) else content


def _checksums(folder: Path) -> list[str]:
    strangers = sorted(path for path in folder.iterdir() if path.name not in (*PUBLISHED, "stale.csv"))
    return [
        *(f"{path}: is not one of {', '.join(PUBLISHED)}" for path in strangers),
        *(difference for name in PUBLISHED for difference in altered(folder / name)),
    ]


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "results/published/paper")))
