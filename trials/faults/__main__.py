"""All faults on the smoke study: results/faults/faults.csv, a row for each; fails unless all are passed."""

from __future__ import annotations

import argparse
import signal
import sys
import tempfile
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from asphalt_nscd.files.store import provenance, write_json, write_table
from faults.judge import IMPOSSIBLE, PASSED, Judged, judge
from faults.kills import KIND, kill_each_rule
from faults.study import Study
from faults.table import standing

OUTPUT = Path("results/faults")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wanted", nargs="*", help="parts of the names or kinds of faults; all if left out")
    parser.add_argument("--finished", type=Path, help="folder where this study has been finished before")
    given = parser.parse_args()
    # A shell has what it starts in the background ignore Ctrl-C, and so would all that is started here.
    signal.signal(signal.SIGINT, signal.default_int_handler)

    def asked(kind: str, name: str) -> bool:
        return not given.wanted or any(words in f"{kind}: {name}" for words in given.wanted)

    rows: list[Judged] = []
    with tempfile.TemporaryDirectory() as root:
        finished = _finished(given.finished, Path(root, "finished"))
        if asked(KIND, ""):
            rows += kill_each_rule(finished, Path(root, "kills"))
        faults = [(kind, fault) for kind, faults in standing().items() for fault in faults]
        for kind, fault in tqdm(faults, mininterval=30):
            if asked(kind, fault.name):
                rows.append(judge(kind, fault, finished, Path(root, "copy")))
                tqdm.write(" | ".join((rows[-1].verdict, rows[-1].fault, rows[-1].sentence)))
                write_table(OUTPUT / "faults.csv", pd.DataFrame(rows))
    table = pd.DataFrame(rows)
    write_table(OUTPUT / "faults.csv", table)
    write_table(OUTPUT / "summary.csv", _summary(table))
    write_json(OUTPUT / "provenance.json", provenance())
    failed = table[~table.verdict.isin([PASSED, IMPOSSIBLE])]
    print(f"{len(rows)} faults, {len(failed)} not passed: {OUTPUT}/faults.csv")
    print("\n".join(f"{row.fault}: {row.verdict}" for row in failed.itertuples()))
    return 1 if len(failed) else 0


def _summary(table: pd.DataFrame) -> pd.DataFrame:
    counted = table.assign(
        faults=1, passed=table.verdict == PASSED, not_possible_here=table.verdict == IMPOSSIBLE
    )
    columns = ["faults", "passed", "not_possible_here"]
    return counted.groupby("kind", sort=False)[columns].sum().reset_index()


def _finished(before: Path | None, folder: Path) -> Study:
    if before is not None:
        return Study.at(before.resolve())
    study = Study(folder)
    study.configure()
    done = study.finish()
    if done.returncode:
        raise SystemExit(done.stderr)
    return study


if __name__ == "__main__":
    sys.exit(main())
