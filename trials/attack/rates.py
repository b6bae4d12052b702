"""Tables of the attack: one row for each fault, and the rates that are judged, with Wilson's intervals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from .plan import MASKED, OF_ONE_PLACE, SLIPS

SWEEP = "temperature of one specimen on one isotherm"
WRONG = ["wrong_confident", "wrong_possible"]  # names
BINS = (0.0, 0.5, 0.7, 0.9, 0.95, 0.99, 1.0)  # of stated probabilities


def rate(hits: Iterable[Any]) -> dict[str, float]:
    """Number, hits, rate and 95 % interval (Wilson 1927); missing values are left out."""
    known = pd.Series(list(hits), dtype=object).dropna().astype(bool)
    n, hits = len(known), int(known.sum())
    if not n:
        return {"n": 0, "hits": 0, "rate": np.nan, "low": 0.0, "high": 1.0}
    interval = binomtest(hits, n).proportion_ci(method="wilson")
    return {"n": n, "hits": hits, "rate": hits / n, "low": float(interval.low), "high": float(interval.high)}


def by_fault(rows: pd.DataFrame) -> pd.DataFrame:
    """How often a fault was named, told, removed, and what was wrong beside it, by fault and size over limit."""
    said = ["named", "confident", "told", "removed", "covered"]
    beside = [*WRONG, "good_rejected"]
    counts = rows.reindex(columns=["measured", "suite", "fault", "ratio", *said]).assign(n=1)
    counts[said] = counts[said].astype(float)
    counts[beside] = rows[beside] > 0
    by_fault = counts.groupby(["measured", "suite", "fault", "ratio"], dropna=False)
    return by_fault[["n", *said, *beside]].sum(min_count=1).reset_index()


def coverage(rows: pd.DataFrame) -> pd.DataFrame:
    """Whether the true size lies in the 95 % interval of a name, and the error in standard errors, by cause."""
    named = rows[rows["covered"].notna()]
    parts = [*named.groupby("fault"), ("all", named)]
    return pd.DataFrame(
        [
            {
                "cause": cause, **rate(part["covered"]), "bias_sigma": part["error_sigma"].mean(),
                "std_sigma": part["error_sigma"].std(),
            }
            for cause, part in parts
        ]
    )  # fmt: skip


def reliability(names: pd.DataFrame) -> pd.DataFrame:
    """How often names are right, by the probability stated for them, and of established and possible ones."""
    parts = {"established": names[names["established"]], "possible": names[~names["established"]]}
    known = names[names["probability"].notna()]
    for low, high in zip(BINS, BINS[1:]):
        inside = known["probability"].between(low, high, inclusive="right")
        if inside.any():
            parts[f"{low:g} - {high:g}"] = known[inside]
    return pd.DataFrame(
        [
            {"stated": label, "mean_stated": part["probability"].mean(), **rate(part["right"])}
            for label, part in parts.items()
        ]
    )


def _off(names: pd.DataFrame) -> list[bool]:
    """Of each bin of stated probabilities with ten names or more, whether its share right is within five points."""
    table = reliability(names)
    bins = table[
        table["mean_stated"].notna() & ~table["stated"].isin(("established", "possible")) & (table["n"] >= 10)
    ]
    return [
        abs(row.rate - row.mean_stated) <= 0.05 or row.low <= row.mean_stated <= row.high
        for row in bins.itertuples()
    ]


def summary(rows: pd.DataFrame, names: pd.DataFrame, before: pd.DataFrame | None = None) -> pd.DataFrame:
    """Each criterion with its rate, interval, and whether it is met; before: the summary of an earlier commit."""
    invented, real = rows[~rows["measured"]], rows[rows["measured"]]
    put, empty, pair, outside, own, slips = (
        invented[invented["suite"] == suite]
        for suite in ("catalogue", "nothing", "pair", "outside", "place", "slip")
    )
    # A broken isotherm is structure that no cause has: such a table rightly ends unexplained.
    left, cracked = empty["verdict"] == "unexplained_structure", empty["broken"].astype(bool)
    alone, ten, noted, masked = (slips[slips["fault"] == kind] for kind in (*SLIPS, MASKED))
    false_bias = noted[WRONG].sum(axis=1) > 0
    broken = empty.loc[empty["broken"], "broken_found"]
    drawn = outside[outside["fault"].isin(OF_ONE_PLACE)]
    warm = drawn["fault"] == SWEEP
    beside = invented.loc[invented["suite"].isin(("catalogue", "pair")), "wrong_confident"] > 0
    covered = put["covered"].tolist() + pair["covered"].tolist()
    worst = coverage(invented).query("cause != 'all' and n >= 5")["rate"]
    real_new = real.loc[real["suite"] != "nothing", "wrong_confident"] > 0
    real_put, real_outside = (real[real["suite"] == suite] for suite in ("catalogue", "outside"))
    both = pair.groupby("table")["named"].agg(lambda named: bool(named.astype(bool).all()))

    def at(part: pd.DataFrame, ratio: float, column: str = "named") -> pd.Series:
        return part.loc[part["ratio"] == ratio, column]

    lines = [
        line("causes of the catalogue at 3 limits: named", ">= 98 %", at(put, 3.0), low=0.98),
        line("the same with confidence", "reported", at(put, 3.0, "confident")),
        line("at 2 limits: named", ">= 95 %", at(put, 2.0), low=0.95),
        line("at the stated limit: named", ">= 90 %", at(put, 1.0), low=0.90),
        line("beside causes and pairs: a wrong name with confidence", "<= 3 %", beside, high=0.03),
        line("pairs at 3 limits: both named", ">= 90 %", both, low=0.90),
        line("nothing put in: a name with confidence", "<= 1 %", empty["wrong_confident"] > 0, high=0.01),
        line("nothing put in: a possible name", "<= 5 %", empty["wrong_possible"] > 0, high=0.05),
        line("nothing put in, no isotherm broken: unexplained", "<= 15 %", left[~cracked], high=0.15),
        line("nothing put in, an isotherm broken: unexplained", "reported", left[cracked]),
        line("nothing put in: a test left out that is good", "reported", empty["good_rejected"] > 0),
        line("outside the catalogue: told", "reported", outside["told"]),
        line("of one specimen or one isotherm: told", ">= 90 %", own["told"], low=0.90),
        line("of one specimen or one isotherm, sizes drawn: told", "reported", drawn.loc[~warm, "told"]),
        line("temperature of one specimen 1 to 3 K off: told", "reported", drawn.loc[warm, "told"]),
        line("outside: a wrong name with confidence", "<= 3 %", outside["wrong_confident"] > 0, high=0.03),
        line("outside: a wrong possible name", "reported", outside["wrong_possible"] > 0),
        line("single bad tests: left out", "reported", alone.get("removed", [])),
        line("masked pairs of bad tests: both left out", ">= 60 %", masked.get("removed", []), low=0.60),
        line("masked pairs: a good test left out", "<= 5 %", masked["good_rejected"] > 0, high=0.05),
        line("slip of ten: left out", "reported", ten.get("removed", [])),
        line("slip of ten: a good test left out", "none", ten["good_rejected"] > 0, high=0.0),
        line("wrong recorded temperature: a false name", "none", false_bias, high=0.0),
        line("the same: told", "reported", noted["told"]),
        line("broken isotherms: found", ">= 90 %", broken, low=0.90),
        line("broken isotherms: said where none is", "<= 2 %", empty["broken_false"], high=0.02),
        line("size in its 95 % interval", "92 - 98 %", covered, low=0.92, high=0.98),
        line("causes whose sizes are in it in 88 % or more", "all", worst >= 0.88, low=1.0),
        line("probabilities stated: groups within 5 points", "all", _off(names), low=1.0),
        line("measured tables, causes at 2 and 3 limits: named", ">= 90 %", real_put["named"], low=0.90),
        line("measured: a wrong name added with confidence", "<= 3 %", real_new, high=0.03),
        line("measured, outside: told", "reported", real_outside["told"]),
        line("answers with a name whose interval holds zero", "none", rows["hold_zero"] > 0, high=0.0),
        line("answers that keep an established cause to themselves", "none", rows["unsaid"], high=0.0),
        line("diagnoses that failed", "none", rows["verdict"] == "failed", high=0.0),
    ]  # fmt: skip
    table = pd.DataFrame(lines)
    if before is not None:
        table.insert(2, "percent_before", table["what"].map(before.set_index("what")["percent"]))
    return table


def inside(rows: pd.DataFrame) -> pd.DataFrame:
    """The criteria of faults inside NSCD runs."""
    put, empty = (rows[rows["suite"] == suite] for suite in ("inside", "nothing"))
    return pd.DataFrame(
        [
            line("inside NSCD runs at 3 limits: named", ">= 95 %", put["named"], low=0.95),
            line("the same: a wrong name with confidence", "none", put["wrong_confident"] > 0, high=0.0),
            line("nothing put in: a name", "none", empty[WRONG].sum(axis=1) > 0, high=0.0),
            line("size in its 95 % interval", "reported", put["covered"]),
        ]
    )


def line(what: str, target: str, hits: Iterable[Any], low: float = 0.0, high: float = 1.0) -> dict[str, Any]:
    """A row of a summary: a rate, its interval, and whether it is met."""
    found = rate(hits)
    met = "not tried" if not found["n"] else "yes" if low <= found["rate"] <= high else "no"
    percent = {name: round(100.0 * found[name], 1) for name in ("rate", "low", "high")}
    return {
        "what": what, "target": target, "percent": percent["rate"],
        "interval_percent": f"{percent['low']} - {percent['high']}" if found["n"] else "", "of": found["n"],
        "met": "" if target == "reported" else met,
    }  # fmt: skip


def frames(lines: Iterable[Mapping[str, Any]]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """All rows of faults, and all names, of the lines of the parts."""
    lines = list(lines)
    rows = pd.DataFrame([row for line in lines for row in line["rows"]])
    columns = ["table", "suite", "cause", "established", "probability", "right"]
    names = pd.DataFrame([row for line in lines for row in line["names"]], columns=columns)
    return rows, names.astype({"established": bool, "right": bool, "probability": float})
