"""All faults on the smoke study: results/faults/faults.csv, a row for each; fails unless all are passed."""

from __future__ import annotations

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


def main(wanted: list[str]) -> int:
    """wanted: parts of the names of faults, all of them if empty."""
    with tempfile.TemporaryDirectory() as root:
        finished = Study(Path(root, "finished"))
        finished.configure()
        done = finished.finish()
        if done.returncode:
            print(done.stderr, file=sys.stderr)
            return 1
        faults = [
            fault
            for fault in all_faults(finished)
            if not wanted or any(words in fault.name for words in wanted)
        ]
        rows = []
        for number, fault in enumerate(tqdm(faults)):
            rows.append(judge(fault, finished, Path(root, f"copy{number}")))
            tqdm.write(" | ".join((rows[-1].verdict, rows[-1].fault, rows[-1].sentence)))
    write_table(OUTPUT, pd.DataFrame(rows))
    failed = [row for row in rows if row.verdict not in ("passed", "not possible here")]
    print(f"{len(rows)} faults, {len(failed)} not passed: {OUTPUT}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
