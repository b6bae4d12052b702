"""Laboratory layouts: how many are read, refused, and read wrongly, and whether mends hold. In a folder, as tables:

PYTHONPATH=trials .venv/bin/python -m layouts [NUMBER] [SEED] [--output FOLDER]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import provenance, write_json, write_table
from layouts.files import draw
from layouts.laboratory import Laboratory
from layouts.refusals import refusals
from layouts.score import outcome

REFUSED = 60  # files that are refused, whose mends are tried
LEAST = 0.95  # share that must be read


def tried(number: int, first: int, folder: Path) -> pd.DataFrame:
    """One row for each file: family, language, ending, whether it was read, refused or wrong, and the sentence."""
    rows = []
    for seed in range(first, first + number):
        family, path, tests = draw(seed, folder)
        result, why = outcome(path, tests, "M1" if family == "two_mixes" else None)
        why = why.replace(f"{folder}/", "")
        rows.append((path.name, family, Laboratory(seed).language, path.suffix, result, why))
        if why:
            print(f"{result}: {path.name}: {why}")
    return pd.DataFrame(rows, columns=["file", "family", "language", "ending", "result", "sentence"])


def summary(files: pd.DataFrame) -> pd.DataFrame:
    """Counts of each family, and of all."""
    kinds = pd.CategoricalDtype(["read", "refused", "wrong"])
    counts = pd.crosstab(files["family"], files["result"].astype(kinds), dropna=False)
    counts.loc["all"] = counts.sum()
    counts.insert(0, "files", counts.sum(axis=1))
    return counts.reset_index().rename_axis(columns=None)


def tried_mends(refused: pd.DataFrame) -> pd.DataFrame:
    """By what was wrong with a file: how many were read after one sentence, after several, and not."""
    read, once = refused["result"] == "read", refused["steps"] == 1
    kinds = refused.assign(files=1, once=read & once, later=read & ~once, never=~read)
    counts = kinds.groupby("slip", sort=False)[["files", "once", "later", "never"]].sum()
    counts.loc["all"] = counts.sum()
    return counts.reset_index()


def main(number: int, first: int, output: Path | None) -> int:
    with tempfile.TemporaryDirectory() as folder:
        files = tried(number, first, Path(folder))
        refused = refusals(REFUSED, first, Path(folder))
    counts, mends = summary(files), tried_mends(refused)
    print(counts.to_string(index=False), mends.to_string(index=False), sep="\n")
    if output is not None:
        write_table(output / "layouts.csv", files)
        write_table(output / "summary.csv", counts)
        write_table(output / "refusals.csv", refused)
        write_table(output / "mends.csv", mends)
        write_json(output / "provenance.json", provenance())
    wrong = [*files["result"], *refused["result"]].count("wrong")
    return int(wrong > 0 or (files["result"] == "read").mean() < LEAST)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("number", type=int, nargs="?", default=36)
    parser.add_argument("seed", type=int, nargs="?", default=0)
    parser.add_argument("--output", type=Path)
    given = parser.parse_args()
    sys.exit(main(given.number, given.seed, given.output))
