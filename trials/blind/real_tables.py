"""Rates of the causes put into real and real-like tables, with their intervals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import pandas as pd

from . import score
from .plan import JUDGED
from .tables import judge

COLUMNS = (
    "table", "kind", "seed", "cause", "ratio", "sign", "verdict", "named", "established", "named_before", "elsewhere",
    "added", "instead", "covered", "error_sigma", "covered_alike", "error_sigma_alike", "own_over_limit", "any_name",
    "wrong", "odd_named", "wrong_names", "not_drawn", "failed", "error", "cpu_s",
)  # fmt: skip
CHANNELS = ("channel_delay", "phase_offset")
CHANNEL_RATIOS = (3.0, 6.0)
SMALL_OWN = 0.5  # of the limit: below, what a table has of its own hardly adds to what is put in
GROUPS = ("real", "drawn", "all")


def cases(rows: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """One row for each table as it is, and one for each effect put into it."""
    return pd.DataFrame(rows).reindex(columns=COLUMNS)


def efficiency(table: pd.DataFrame) -> pd.DataFrame:
    """Named, and named with confidence, by cause and amplitude over limit; in real tables, drawn ones and all."""
    rows = []
    for where, part in _groups(hidden(table)):
        for (cause, ratio), group in _by(part, ["cause", "ratio"]):
            rows.append(
                {"tables": where, "cause": cause, "ratio": ratio} | _rates(group, "named", "established")
            )
    return pd.DataFrame(rows)


def false_names(table: pd.DataFrame) -> pd.DataFrame:
    """By kind of table: confident names of a table without a cause, and names added to those it had."""
    bare, put = bare_tables(table), hidden(table)
    rows = []
    for kind in [*dict.fromkeys(table["kind"]), "all"]:
        own = bare if kind == "all" else bare[bare["kind"] == kind]
        added = put if kind == "all" else put[put["kind"] == kind]
        rows.append({"kind": kind, "of": "without a cause", **score.rate(own["wrong"] > 0)})
        rows.append({"kind": kind, "of": "added", **score.rate(added["added"] > 0)})
    return pd.DataFrame(rows)


def coverage(table: pd.DataFrame) -> pd.DataFrame:
    """Whether the size grew by what was put in, within its 95 % interval; error in standard errors, by cause."""
    rows = []
    for where, part in _groups(hidden(table)):
        for (cause,), group in _by(part, ["cause"]):
            error = group["error_sigma"].dropna().astype(float)
            told = score.rate(group["covered"])
            rows.append(
                {
                    "tables": where,
                    "cause": cause,
                    **told,
                    "bias_sigma": error.mean(),
                    "std_sigma": error.std(),
                }
            )
    return pd.DataFrame(rows)


def limits(table: pd.DataFrame) -> pd.DataFrame:
    """Power at the stated limit, 95 % by its definition, of all tables, and where the own value is small."""
    at = hidden(table)
    at = at[at["ratio"] == 1.0]
    rows = []
    for where, part in _groups(at):
        for (cause,), group in _by(part, ["cause"]):
            small = group[~(group["own_over_limit"].astype(float) > SMALL_OWN)]
            for own, some in (("any", group), ("small", small)):
                rows.append(
                    {
                        "tables": where,
                        "cause": cause,
                        "own_value": own,
                        "stated": 0.95,
                        **score.rate(some["named"]),
                    }
                )
    return pd.DataFrame(rows)


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Each criterion with its rate, 95 % interval, and whether it is met."""
    put, bare = hidden(table), bare_tables(table)
    channels = put[(put["kind"] == "real") & put["cause"].isin(CHANNELS) & put["ratio"].isin(CHANNEL_RATIOS)]
    judged, at_limit = put[put["ratio"] == JUDGED], put[put["ratio"] == 1.0]
    own = at_limit["own_over_limit"].astype(float)
    odd = table["odd_named"].dropna().astype(bool)
    lines = [
        judge("real tables, offset and delay at 3 and 6 limits: named", ">= 95 %", channels["named"], low=0.95),
        judge("the same: size grew by what was put in, within its interval", ">= 90 %", channels["covered"], low=0.90),
        judge("the same, over its size with the same tests and causes", ">= 90 %", channels["covered_alike"], low=0.90),
        judge("the same: a wrong name instead", "none", channels["instead"], high=0.0),
        judge(f"all causes at {JUDGED:g} times the limit: named", ">= 90 %", judged["named"], low=0.90),
        judge("the same: named with confidence", "reported", judged["established"]),
        judge("the same: size grew by what was put in, within its interval", "reported", judged["covered"]),
        judge("the same, over its size with the same tests and causes", "reported", judged["covered_alike"]),
        judge("false names added, any cause and ratio", "<= 3 %", put["added"] > 0, high=0.03),
        judge("tables without a cause: misnamed with confidence", "<= 5 %", bare["wrong"] > 0, high=0.05),
        judge("the same: any name, with confidence or without", "reported", bare["any_name"] > 0),
        judge("odd specimens: the odd one's size named", "reported", odd),
        judge("power at the stated limit", "85 - 99 %", at_limit["named"], low=0.85, high=0.99),
        judge("the same where the table's own value is small", "reported", at_limit.loc[~(own > SMALL_OWN), "named"]),
        judge("diagnoses that failed", "none", table["failed"], high=0.0),
    ]  # fmt: skip
    return pd.DataFrame(lines)


def hidden(table: pd.DataFrame) -> pd.DataFrame:
    """Rows of effects that were put in and diagnosed."""
    part = table[(table["cause"] != score.NOTHING) & table["not_drawn"].isna()]
    return part.astype({name: bool for name in ("named", "established", "instead")})


def bare_tables(table: pd.DataFrame) -> pd.DataFrame:
    """Drawn tables as they are."""
    return table[(table["cause"] == score.NOTHING) & (table["kind"] != "real")]


def _groups(table: pd.DataFrame) -> Iterable[tuple[str, pd.DataFrame]]:
    real = table["kind"] == "real"
    parts = zip(GROUPS, (table[real], table[~real], table))
    return [(name, part) for name, part in parts if len(part)]


def _by(table: pd.DataFrame, columns: list[str]) -> Iterable[tuple[tuple, pd.DataFrame]]:
    """Groups by cause, and all causes together."""
    return [*table.groupby(columns), *table.assign(cause="all").groupby(columns)]


def _rates(group: pd.DataFrame, *names: str) -> dict[str, float]:
    row: dict[str, float] = {"n": len(group)}
    for name in names:
        found = score.rate(group[name])
        row |= {name: found["rate"], f"{name}_low": found["low"], f"{name}_high": found["high"]}
    return row
