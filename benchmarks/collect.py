"""All rows in one table, those beside peers, and how each stage grows: cpu ~ spheres^exponent.

python benchmarks/collect.py ROWS.csv... --output TABLE.csv --beside BESIDE.csv --growth GROWTH.csv
    --million MILLION.csv --earlier FOLDER

Rows of the FOLDER's benchmark.csv that were not measured now are kept, and say of which commit they are: the largest
size of the growth alone takes most of an hour.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import pandas as pd
from rows import COLUMNS

from asphalt_nscd.files.store import write_table
from asphalt_nscd.nscd.bonds.implicit_operator import LARGEST_FACTORED

OF_UNKNOWNS = (
    "condense",
    "reduced, a cycle",
    "condensed, factors",
    "condensed, a step",
)  # which are solved for
LEFT = 0.66  # of the spheres poured, in the specimen


def exponents(table: pd.DataFrame) -> pd.DataFrame:
    """One row for each stage: least squares of log cost and log memory against log size.

    Over all sizes done, and, as `last`, from the last but one to the largest.
    """
    rows = []
    done = table[(table.topic == "growth") & table.cpu_s.notna()]
    for case, group in done.groupby("case", sort=False):
        group = group.sort_values("spheres")
        size = np.log(group.spheres.to_numpy(float))
        row = {"stage": case, "from": int(group.spheres.min()), "to": int(group.spheres.max())}
        for column, name in (("cpu_s", "exponent_of_time"), ("memory_MB", "exponent_of_memory")):
            cost = np.log(group[column].to_numpy(float))
            several = size.size > 1
            row[name] = np.polyfit(size, cost, 1)[0] if several else np.nan
            row[f"last_{name}"] = (cost[-1] - cost[-2]) / (size[-1] - size[-2]) if several else np.nan
        largest = group.iloc[-1]
        rows.append(row | {"cpu_s_of_largest": largest.cpu_s, "memory_MB_of_largest": largest.memory_MB})
    return pd.DataFrame(rows)


def million(table: pd.DataFrame) -> pd.DataFrame:
    """What each stage of a million spheres costs one core, estimated within one algorithm.

    Multigrid, above `LARGEST_FACTORED` unknowns, is no continuation of the factors that serve below. Where one size
    alone was measured with it, time and memory are taken as proportional to the number of spheres.
    """
    rows = []
    done = table[(table.topic == "growth") & table.cpu_s.notna()].sort_values("spheres")
    for case, group in done.groupby("case", sort=False):
        if case in OF_UNKNOWNS:
            group = group[6 * LEFT * group.spheres > LARGEST_FACTORED]
        if group.empty:
            continue
        sizes, largest = np.log(group.spheres.tail(2).to_numpy(float)), group.iloc[-1]
        row = {"stage": case, "from": int(group.spheres.tail(2).min()), "to": int(largest.spheres)}
        for column, name, unit in (("cpu_s", "cpu_h", 3600.0), ("memory_MB", "memory_GB", 1000.0)):
            cost = np.log(group[column].tail(2).to_numpy(float))
            power = (cost[-1] - cost[0]) / (sizes[-1] - sizes[0]) if sizes.size > 1 else 1.0
            row[f"exponent_{name}"] = power
            row[name] = largest[column] * (1e6 / largest.spheres) ** power / unit
        rows.append(row)
    return pd.DataFrame(rows)


def with_earlier(table: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """Rows measured now, then those of an earlier table that are not among them; of what is absent now the earlier."""
    commit = json.loads((folder / "provenance.json").read_text())["git_commit"][:7]
    before = pd.read_csv(folder / "benchmark.csv")[COLUMNS]
    before = before[~_absent(before)]
    known = {*before.topic, *zip(before.topic, before.case, strict=True)}
    named = table.topic.where(table.case.isna(), list(zip(table.topic, table.case, strict=True)))
    table = table[~(_absent(table) & named.isin(known))]
    both = pd.concat([table, before], ignore_index=True)
    size = both.spheres.where(both.topic == "growth")  # beside peers a case has one size
    both = both[~both.assign(size=size).duplicated(["topic", "case", "size"])].reset_index(drop=True)
    remark = both["remark"].fillna("")
    earlier = (both.index >= len(table)) & ~remark.str.contains("measured at ")
    both.loc[earlier, "remark"] = (remark[earlier] + f"; measured at {commit}").str.removeprefix("; ")
    return both


def _absent(table: pd.DataFrame) -> pd.Series:
    return table["remark"].fillna("").str.startswith("absent: ")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rows", nargs="+", type=Path)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--beside", type=Path, required=True)
    parser.add_argument("--growth", type=Path, required=True)
    parser.add_argument("--million", type=Path, required=True)
    parser.add_argument("--earlier", type=Path)
    told = parser.parse_args()
    table = pd.concat([pd.read_csv(path) for path in told.rows], ignore_index=True)[COLUMNS]
    if told.earlier:
        table = with_earlier(table, told.earlier)
    write_table(told.output, table)
    write_table(told.beside, table[table.topic != "growth"])
    write_table(told.growth, exponents(table))
    write_table(told.million, million(table))


if __name__ == "__main__":
    main()
