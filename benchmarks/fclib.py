"""Frictional contact problems in FCLIB's format, solved to 1e-8.

python benchmarks/fclib.py FILE... --output ROWS.csv
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd
from rows import write_rows

from asphalt_nscd.contact_problems.fclib import solve_files

TOPIC = "FCLIB to 1e-8"
SICONOS = Path(__file__).with_name("siconos.csv")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--output", type=Path, required=True)
    told = parser.parse_args()
    siconos = pd.read_csv(SICONOS, comment="#", index_col="problem")
    rows = []
    for outcome in solve_files(told.files, 1e-8):
        remark = f"{outcome.contacts} contacts, {outcome.iterations} iterations, error {outcome.error:.0e}"
        if not outcome.converged:
            remark += ", NOT converged"
        name = Path(outcome.file).stem
        if name in siconos.index:
            default, fastest = siconos.loc[name]
            remark += f"; Siconos once took {default:g} s, {fastest:g} s by its fastest local solver"
        row = {"topic": TOPIC, "case": name, "cpu_s": outcome.seconds, "remark": remark}
        rows.append(row)
    write_rows(
        told.output, rows or [{"topic": TOPIC, "remark": "absent: no files given, make benchmark FCLIB=..."}]
    )


if __name__ == "__main__":
    main()
