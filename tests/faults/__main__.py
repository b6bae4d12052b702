"""All faults on the smoke study: results/faults/faults.csv, a row for each; fails unless all are passed."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from asphalt_nscd.store import write_table
from faults.judge import judge
from faults.study import Study
from faults.table import all_faults

OUTPUT = Path("results/faults/faults.csv")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wanted", nargs="*", help="parts of the names of faults; all if left out")
    parser.add_argument("--finished", type=Path, help="folder where this study has been finished before")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as root:
        finished = _finished(given.finished, Path(root, "finished"))
        faults = [
            fault
            for fault in all_faults(finished)
            if not given.wanted or any(words in fault.name for words in given.wanted)
        ]
        rows = []
        for number, fault in enumerate(tqdm(faults, mininterval=30)):
            rows.append(judge(fault, finished, Path(root, f"copy{number}")))
            tqdm.write(" | ".join((rows[-1].verdict, rows[-1].fault, rows[-1].sentence)))
    write_table(OUTPUT, pd.DataFrame(rows))
    failed = [row for row in rows if row.verdict not in ("passed", "not possible here")]
    print(f"{len(rows)} faults, {len(failed)} not passed: {OUTPUT}")
    return 1 if failed else 0


def _finished(before: Path | None, folder: Path) -> Study:
    if before is not None:
        return Study.at(before)
    study = Study(folder)
    study.configure()
    done = study.finish()
    if done.returncode:
        raise SystemExit(done.stderr)
    return study


if __name__ == "__main__":
    sys.exit(main())
