"""Frictional contact problems in FCLIB's format, solved to 1e-8.

python benchmarks/fclib.py FILE... --output ROWS.csv
"""

from __future__ import annotations

import argparse
from pathlib import Path

from rows import write_rows

from asphalt_nscd.fclib import solve_files

TOPIC = "FCLIB to 1e-8"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    rows = []
    for outcome in solve_files(told.files, 1e-8):
        remark = f"{outcome.contacts} contacts, {outcome.iterations} iterations, error {outcome.error:.0e}"
        if not outcome.converged:
            remark += ", NOT converged"
        row = {"topic": TOPIC, "case": Path(outcome.file).stem, "cpu_s": outcome.seconds, "remark": remark}
        rows.append(row)
    write_rows(
        told.output, rows or [{"topic": TOPIC, "remark": "absent: no files given, make benchmark FCLIB=..."}]
    )


if __name__ == "__main__":
    main()
