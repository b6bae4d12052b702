"""A large layer from its first sphere to |E*| under both mappings, by the public commands.

    python benchmarks/layer.py SPHERES COUNTS LAW --threads 2 --output ROWS.csv

The paper's grading, box and specimen scaled as in growth.py; the whole second of vibration. The files of
all stages stay in a folder beside the table.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import time
from pathlib import Path

import numpy as np
import pandas as pd
from growth import BOX, FREQUENCY, GEOMETRY, MASS

from asphalt_nscd.files.store import write_table
from asphalt_nscd.specimen.counts import read_counts

TEMPERATURE = 20.0  # degC, of the law

Row = dict[str, object]


def run(stage: str, *command: object) -> Row:
    """One public command as a process: what it cost."""
    print(stage, *command, flush=True)
    began = time.perf_counter()
    process = subprocess.Popen(["asphalt-nscd", *map(str, command)])
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{stage} failed with exit code {process.returncode}")
    return {
        "stage": stage,
        "wall_s": time.perf_counter() - began,
        "cpu_s": used.ru_utime + used.ru_stime,
        "memory_MB": used.ru_maxrss / 1024.0,
    }


def layer(spheres: int, counts_table: str, law: str, threads: int, folder: Path) -> list[Row]:
    """All stages, each with its row; files stay in the folder."""
    diameters, counts = read_counts(counts_table)
    share = spheres / counts.sum()
    scale = share ** (1.0 / 3.0)
    box = ",".join(f"{scale * side:.6g}" for side in BOX)
    geometry = {key: scale * value for key, value in GEOMETRY.items()}
    geometry |= {key: share * value for key, value in MASS.items()}
    trapezoid = ",".join(f"{key}={value:.6g}" for key, value in geometry.items())
    table, deposit = folder / "counts.csv", folder / "deposit.h5"
    scaled = pd.DataFrame({"diameter_mm": 1e3 * diameters, "count": np.rint(counts * share).astype(int)})
    scaled.to_csv(table, index=False)

    pour = ("--counts", table, "--box-m", box, "--seed", 1, "--threads", threads, "--output", deposit)
    rows = [run("pour and vibrate", "deposit", *pour) | {"threads": threads}]
    for area in ("paper", "facets"):
        specimen, model, excerpt, test, found = (
            folder / f"{area}-{part}"
            for part in ("specimen.h5", "model.h5", "excerpt.h5", "test.h5", "test.csv")
        )
        cut = ("trim", deposit, "--geometry", trapezoid, "--area", area, "--output", specimen)
        rows.append(run(f"trim and bond, {area}", *cut))
        reduced = ("condense", specimen, "--excerpt-output", excerpt, "--output", model)
        rows.append(run(f"condense, {area}", *reduced))
        bend = ("--law", law, "--temperature-c", TEMPERATURE, "--frequency-hz", FREQUENCY, "--output", test)
        row = run(f"one test, {area}", "simulate", model, "--excerpt", excerpt, *bend)
        run("collect", "collect", test, "--output", found)
        rows.append(row | {"remark": beside_the_law(found)})
    return rows


def beside_the_law(table: Path) -> str:
    """What the test gave, beside its law."""
    test = pd.read_csv(table).iloc[0]
    turned = test["phase_deg"] - test["phase_law_deg"]
    return (
        f"{test['spheres']} spheres and {test['bonds']} bonds, {test['broken_bonds']} broken, "
        f"|E*| over law {test['E_MPa'] / test['E_law_MPa']:.4f}, phase over law {turned:+.3f} deg, "
        f"residual {test['residual']:.0e}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spheres", type=int)
    parser.add_argument("counts")
    parser.add_argument("law")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    folder = told.output.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    rows = layer(told.spheres, told.counts, told.law, told.threads, folder)
    columns = ["stage", "threads", "wall_s", "cpu_s", "memory_MB", "remark"]
    write_table(told.output, pd.DataFrame(rows, columns=columns))


if __name__ == "__main__":
    main()
