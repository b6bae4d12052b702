"""Tables of the campaign: one row per hidden effect, and the rates that are judged."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from . import score
from .causes import CATALOGUE
from .plan import JUDGED

PLANNED = ("suite", "design", "form", "shape", "removed")
COLUMNS = (
    "case", "seed", "suite", "cause", "where", "ratio", "amplitude", "strength", "design", "form", "shape",
    "removed", "verdict", "outcome", "found", "named", "grouped", "wrong", "confident", "error_sigma", "covered",
    "gain", "gain_over_scatter", "gain_of_averages",
)  # fmt: skip
# Ways to put the held-out error: of single tests, judged; over their scatter; of averages over specimens, as in
# Table 4, which hide what a cause does to one of them: such causes are reported apart.
GAINS = {
    "gain": {},
    "gain_over_scatter": {"errors": ("rms_over_scatter",)},
    "gain_of_averages": {"averages": True},
}
OF_ONE_SPECIMEN = [name for name, effect in CATALOGUE.items() if effect.confined == "specimen"]
SEPARABLE = 8  # causes whose removal must leave their effect unexplained


def cases(lines: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """One row per hidden effect and one per empty case; cases of which nothing could be drawn are left out."""
    lines = [line for line in lines if "seal" in line]
    table = score.outcomes([(line["seal"], line["diagnosis"]) for line in lines])
    for name in PLANNED:
        table[name] = [lines[number]["case"][name] for number in table["case"]]
    table["suite"] = table["suite"].replace("limits", "empty")
    for name, how in GAINS.items():
        table[name] = [_gain(row, lines[row.case]["diagnosis"], how) for row in table.itertuples()]
    return table.reindex(columns=COLUMNS)


def _gain(row: Any, diagnosis: Mapping[str, Any], how: Mapping[str, Any]) -> float:
    """ln of the held-out error before over after, of the rung that names the effect."""
    for rung in diagnosis["ladder"]:
        if row.named and rung["cause"] == row.cause and str(rung["where"]) in (str(row.where), "None"):
            gain = score.held_out_gain(rung, **how)
            return np.nan if gain is None else gain
    return np.nan


def efficiency(table: pd.DataFrame) -> pd.DataFrame:
    """Found, and named among the found, by cause and amplitude over limit; `all` pools the causes."""
    single = table[table["suite"] == "single"]
    return pd.concat([score.efficiency(single), score.efficiency(single.assign(cause="all"))])


def isolation(table: pd.DataFrame) -> pd.DataFrame:
    """What was hidden (rows) and what came out (columns), at the ratio that is judged."""
    alone = table[table["suite"].isin(("empty", "outside", "single"))]
    return score.isolation_matrix(alone[alone["ratio"].isna() | (alone["ratio"] == JUDGED)]).reset_index()


def false_alarms(table: pd.DataFrame) -> pd.DataFrame:
    """Empty cases that end with a name, or with structure, by law of the mix; `all` pools them."""
    empty = table[table["suite"] == "empty"]
    rows = []
    for shape, part in [*empty.groupby("shape"), ("all", empty)]:
        for what, hits in (("named", part["wrong"] > 0), ("structure", part["outcome"] == score.UNEXPLAINED)):
            rows.append({"shape": shape, "what": what, **score.rate(hits)})
    return pd.DataFrame(rows)


def coverage(table: pd.DataFrame) -> pd.DataFrame:
    """Whether the true amplitude lies in its 95 % interval, and the error in standard errors, by cause."""
    judged = _judged(table)
    rows = []
    for cause, part in [*judged.groupby("cause"), ("all", judged)]:
        error = part["error_sigma"].dropna().astype(float)
        rows.append(
            {
                "cause": cause,
                **score.rate(part["covered"]),
                "bias_sigma": error.mean(),
                "std_sigma": error.std(),
            }
        )
    return pd.DataFrame(rows)


def gains(table: pd.DataFrame) -> pd.DataFrame:
    """How often, and how far, the held-out error falls by the cause named, in each way to put it."""
    named = table[table["suite"].isin(("pair", "single"))]
    rows = []
    for cause, part in [*named.groupby("cause"), ("all", named)]:
        for way in GAINS:
            gain = part[way].dropna()
            rows.append({"cause": cause, "way": way, **score.rate(gain > 0.0), "median_gain": gain.median()})
    return pd.DataFrame(rows)


def outside(table: pd.DataFrame) -> pd.DataFrame:
    """Effects beyond the catalogue by ratio: ended unexplained, named and not doubted, seen at all."""
    return _unnamed(table[table["suite"] == "outside"], ["cause", "ratio"])


def removal(table: pd.DataFrame) -> pd.DataFrame:
    """Effects whose cause the catalogue lacks: the same rates by the cause removed."""
    return _unnamed(table[table["suite"] == "removal"], ["cause"])


def inside_runs(table: pd.DataFrame) -> pd.DataFrame:
    """Effects hidden inside NSCD runs, one row each."""
    return table[table["suite"] == "nscd"].drop(columns=["design", "form", "removed"])


def _unnamed(part: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    rows = []
    for key, group in [*part.groupby(by), *part.assign(cause="all").groupby(by)]:
        row = dict(zip(by, key, strict=True)) | {"n": len(group)}
        for what, hits in _verdicts(group).items():
            rate = score.rate(hits)
            row |= {what: rate["rate"], f"{what}_low": rate["low"], f"{what}_high": rate["high"]}
        rows.append(row)
    return pd.DataFrame(rows)


def _verdicts(group: pd.DataFrame) -> dict[str, pd.Series]:
    confident = group["confident"] > 0
    return {
        "unexplained": (group["verdict"] == score.UNEXPLAINED) & ~confident,
        "confidently_named": confident,
        "unseen": group["outcome"] == score.NOTHING,
    }


def _judged(table: pd.DataFrame) -> pd.DataFrame:
    """At one ratio: cases of a seed share their scatter, so that other ratios repeat the same error."""
    return table[table["suite"].isin(("pair", "single")) & (table["ratio"] == JUDGED)]


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Each criterion of the campaign with its rate, 95 % interval, and whether it is met."""
    single = table[table["suite"] == "single"]
    judged = single[single["ratio"] == JUDGED]
    empty = table[table["suite"] == "empty"]
    beyond = _verdicts(table[(table["suite"] == "outside") & (table["ratio"] == JUDGED)])
    alarms = score.rate(empty["wrong"] > 0)
    named = table[table["suite"].isin(("pair", "single"))]
    gain = {way: named[way].dropna() > 0.0 for way in GAINS}
    of_one = named["cause"].isin(OF_ONE_SPECIMEN)
    runs = table[table["suite"] == "nscd"]
    inside = runs[runs["cause"] != score.NOTHING]
    at = f"at {JUDGED:g} times the limit"
    lines = [
        judge(f"found, {at}", ">= 95 %", judged["found"], low=0.95),
        judge(f"named rightly among the found, {at}", ">= 95 %", judged.loc[judged["found"], "named"], low=0.95),
        judge("false alarms of empty cases", "<= 2 %", empty["wrong"] > 0, high=0.02),
        judge("empty cases that end with structure, without a name", "reported", empty["outcome"] == score.UNEXPLAINED),
        _row("false alarms, upper 95 % bound", "<= 5 %", alarms | {"rate": alarms["high"]}, alarms["high"] <= 0.05),
        judge(f"outside the catalogue: unexplained, {at}", ">= 80 %", beyond["unexplained"], low=0.80),
        judge(f"outside the catalogue: confident wrong name, {at}", "<= 10 %", beyond["confidently_named"], high=0.10),
        judge("amplitude within its 95 % interval", "90 - 98 %", _judged(table)["covered"], low=0.90, high=0.98),
        judge("held-out error of single tests falls where named", ">= 95 %", gain["gain"], low=0.95),
        judge("the same over the scatter of one test", ">= 95 %", gain["gain_over_scatter"], low=0.95),
        judge(
            "the same of averages over specimens, for causes that reach all of them", ">= 95 %",
            gain["gain_of_averages"][~of_one], low=0.95,
        ),
        judge(
            "the same for causes of one specimen, which averages hide", "reported", gain["gain_of_averages"][of_one]
        ),
        judge("both of a pair: each effect named", "reported", table.loc[table["suite"] == "pair", "named"]),
        _separable(removal(table)),
        judge("hidden inside NSCD runs: named", "all", inside["named"], low=1.0),
        judge("inside NSCD runs, the empty ones too: a wrong name beside", "reported", runs["wrong"] > 0),
    ]  # fmt: skip
    return pd.DataFrame(lines)


def judge(what: str, target: str, hits: pd.Series, low: float = 0.0, high: float = 1.0) -> dict[str, Any]:
    """Row of a summary: a rate, its interval, and whether it lies between low and high; or is only reported."""
    found = score.rate(hits)
    return _row(what, target, found, low <= found["rate"] <= high)


def _row(what: str, target: str, found: Mapping[str, float], met: bool) -> dict[str, Any]:
    verdict = "not tried" if not found["n"] else "yes" if met else "no"
    percent = {name: round(100.0 * found[name], 1) for name in ("rate", "low", "high")}
    return {
        "what": what,
        "target": target,
        "percent": percent["rate"],
        "interval_percent": f"{percent['low']} - {percent['high']}",
        "of": found["n"],
        "met": "" if target == "reported" else verdict,
    }


def _separable(removed: pd.DataFrame) -> dict[str, Any]:
    own = removed[removed["cause"] != "all"]
    good = own[(own["unexplained"] >= 0.8) & (own["confidently_named"] <= 0.1)]
    found = score.rate(own["cause"].isin(good["cause"]))
    what = "causes whose removal leaves their effects unexplained (80 %), not misnamed (10 %)"
    return _row(what, f">= {SEPARABLE} causes", found, len(good) >= SEPARABLE) | {"of": len(own)}
