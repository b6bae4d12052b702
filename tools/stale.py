"""Which published tables rest on sources that have changed since, and the command that publishes each anew.

    python tools/stale.py          say so
    python tools/stale.py --write  and keep it in results/published/stale.csv, which a test compares

Sources are the modules behind a table with all that they import, but for those that only carry numbers, and the files
that it was read from (`sources.json` beside it). Run it at the top of a clone.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import read_json
from asphalt_nscd.reporting.publish import RESTS_ON, stale

ROOT = Path(__file__).resolve().parents[1]
LEDGER = Path("results/published/stale.csv")
MAKES = {  # what is made by programs that are no rules
    "publish_faults": "make faults && ",
    "publish_fuzz": "make fuzz && ",
    "publish_calls": "make fuzz && ",
    "publish_mutants": "snakemake mutants --cores 1 && ",
    "publish_cluster": "make cluster && ",
}
MORE = dict.fromkeys(["attack", "publish_machines", "publish_inside"], " config/attack.yaml")


def table() -> pd.DataFrame:
    """Name, why it is stale, and the command that publishes it."""
    rows = []
    for name, why in stale(Path("results/published")).items():
        command = f"snakemake {name} --cores all --configfile config/paper.yaml{MORE.get(name, '')}"
        rows.append((name, why, MAKES.get(name, "") + command))
    return pd.DataFrame(rows, columns=["published", "why", "command"])


def strangers() -> list[str]:
    """Commits that published tables name, and that are not in this history."""
    entries = [read_json(path) for path in sorted(Path("results/published").glob(f"*/{RESTS_ON}"))]
    named = {commit for noted in entries for entry in noted.values() for commit in entry["commits"]}
    known = ["git", "merge-base", "--is-ancestor"]
    return sorted(
        c for c in named if subprocess.run([*known, c, "HEAD"], capture_output=True, check=False).returncode
    )


if __name__ == "__main__":
    found = table()
    print(found.to_string(index=False) if len(found) else "No published table is stale.")
    print("\n".join(f"{commit}: is no commit of this history" for commit in strangers()))
    if "--write" in sys.argv:
        found.to_csv(LEDGER, index=False)
