"""What a diagnosis found of what was hidden: efficiency, isolation, false alarms, coverage, gain.

Input is a list of (seal, diagnosis): the seal of generator.draw and the content of diagnosis.json.
`relaxation_spectrum` is the step from Burgers to a continuous law, true of every case here, and is
never counted for or against a diagnosis. Every rate comes with its 95 % Clopper-Pearson interval.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import beta

Seal = Mapping[str, Any]
Diagnosis = Mapping[str, Any]

TRUE_OF_ALL = "relaxation_spectrum"
NOTHING, UNEXPLAINED, ELSEWHERE = "nothing", "unexplained_structure", "right cause, wrong place"
REFUSED = "refused"  # by the reader, before any diagnosis
PACKING = 0.1  # how well a sample's own stiffness over that of the median sample is to be met
GAUSSIAN_95 = 1.959964  # standard errors


def clopper_pearson(hits: int, trials: int, level: float = 0.95) -> tuple[float, float]:
    """Exact interval of a binomial rate; (0, 1) without trials."""
    tail = 0.5 * (1.0 - level)
    low = float(beta.ppf(tail, hits, trials - hits + 1)) if hits > 0 else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, trials - hits)) if hits < trials else 1.0
    return low, high


def rate(hits: pd.Series) -> dict[str, float]:
    """Number, hits, rate and interval of a column of truth values; missing ones are left out."""
    hits = hits.dropna().astype(bool)
    low, high = clopper_pearson(int(hits.sum()), len(hits))
    share = float(hits.mean()) if len(hits) else np.nan
    return {"n": len(hits), "hits": int(hits.sum()), "rate": share, "low": low, "high": high}


def outcomes(cases: Iterable[tuple[Seal, Diagnosis]]) -> pd.DataFrame:
    """One row per hidden effect, and one per empty case.

    suite: empty, single, pair or outside; ratio: amplitude over detection limit (`ratio` of the effect in
    the seal, else from the diagnosis's own limits); outcome: the true cause if named, else the first
    wrong name, else UNEXPLAINED, REFUSED or NOTHING; named: rightly, in the right place or in a group that cannot be
    told apart; wrong: names that are true of no hidden effect, confident: those of them given as established;
    covered, gained: NaN unless named by itself.
    """
    rows = []
    for number, (seal, diagnosis) in enumerate(cases):
        common = {
            "case": number,
            "seed": seal["seed"],
            "suite": _suite(seal),
            "verdict": diagnosis["verdict"],
        }
        effects = seal["effects"]
        wrong = [
            entry
            for entry in _named(diagnosis)
            if not any(tells(entry, e, diagnosis) for e in effects) and not _of_packing(entry, seal)
        ]
        common |= {"wrong": len(wrong), "confident": sum(established(entry, diagnosis) for entry in wrong)}
        for effect in effects or [None]:
            rows.append(common | _row(effect, wrong, diagnosis))
    return pd.DataFrame(rows)


def established(entry: Mapping[str, Any], diagnosis: Diagnosis) -> bool:
    """Whether a rung is named with confidence."""
    return bool(entry.get("established", diagnosis["verdict"] == "explained"))


def _suite(seal: Seal) -> str:
    if any(effect["kind"] == "outside" for effect in seal["effects"]):
        return "outside"
    return {0: "empty", 1: "single"}.get(len(seal["effects"]), "pair")


def _named(diagnosis: Diagnosis) -> list[Mapping[str, Any]]:
    return [entry for entry in diagnosis["ladder"] if entry["cause"] != TRUE_OF_ALL]


def _row(effect: Mapping[str, Any] | None, wrong: list, diagnosis: Diagnosis) -> dict[str, Any]:
    telling = [entry for entry in _named(diagnosis) if effect and tells(entry, effect, diagnosis)]
    itself = [entry for entry in telling if is_same(entry, effect)]
    row = {"cause": effect["cause"] if effect else NOTHING, "named": bool(telling), "grouped": False}
    if telling:
        row |= {"outcome": effect["cause"], "grouped": not itself}
    elif wrong:
        misplaced = effect is not None and wrong[0]["cause"] == effect["cause"]
        row |= {"outcome": ELSEWHERE if misplaced else wrong[0]["cause"]}
    else:
        row |= {
            "outcome": diagnosis["verdict"] if diagnosis["verdict"] in (UNEXPLAINED, REFUSED) else NOTHING
        }
    row["found"] = row["outcome"] not in (NOTHING, REFUSED)
    if effect is not None:
        row |= {"where": effect["where"], "amplitude": effect["amplitude"], "strength": effect["strength"]}
        row |= {"ratio": _ratio(effect, diagnosis)}
    row |= {"error_sigma": np.nan, "covered": None, "gained": None}
    if itself:
        gain = held_out_gain(itself[0])
        row |= _recovered(effect, itself[0]) | {"gained": None if gain is None else gain > 0.0}
    return row


def _of_packing(entry: Mapping[str, Any], seal: Seal) -> bool:
    """Whether an entry says of a numerical sample what its packing is: stiffer or softer than the others."""
    ratio = seal.get("packing_ratio", {}).get(entry.get("where"))
    if ratio is None or entry["cause"] != "specimen_geometry":
        return False
    said = next(iter(entry["parameters"].values()))["value"]
    return abs(said - (ratio - 1.0)) < PACKING


def is_same(entry: Mapping[str, Any], effect: Mapping[str, Any]) -> bool:
    return _is(effect, entry["cause"], entry.get("where"))


def _is(effect: Mapping[str, Any], cause: str, where: str | float | None) -> bool:
    """Whether a cause and its place are those of the effect; a temperature may come as text."""
    hidden = effect["where"]
    if cause != effect["cause"] or (hidden is None) != (where is None):
        return False
    return hidden is None or str(where) == str(hidden) or _number(where) == _number(hidden)


def _number(where: str | float) -> float:
    """NaN, which equals nothing, for the name of a specimen."""
    try:
        return float(where)
    except ValueError:
        return np.nan


def tells(entry: Mapping[str, Any], effect: Mapping[str, Any], diagnosis: Diagnosis) -> bool:
    """Whether an entry names the effect, itself or through a group reported as indistinguishable."""
    if is_same(entry, effect):
        return True
    for group in diagnosis.get("indistinguishable", []):
        members = [_member(text) for text in group]
        holds_entry = any(_is({"where": None} | entry, *member) for member in members)
        if holds_entry and any(_is(effect, *member) for member in members):
            return True
    return False


def _member(text: str) -> tuple[str, str | None]:
    """Cause and place of a group's member, written `cause` or `cause @ place`."""
    cause, at, where = text.partition(" @ ")
    return cause, where if at else None


def _ratio(effect: Mapping[str, Any], diagnosis: Diagnosis) -> float:
    if "ratio" in effect:
        return float(effect["ratio"])
    limit = diagnosis.get("detection_limits", {}).get(effect["cause"])
    if limit is None or not limit["value"]:
        return np.nan
    value = limit.get("places", {}).get(str(effect["where"]), limit["value"])
    return abs(effect["equivalents"][limit["unit"]] / value)


def _recovered(effect: Mapping[str, Any], entry: Mapping[str, Any]) -> dict[str, Any]:
    """Error of the amplitude in its standard errors: that of the parameter whose unit the seal knows."""
    for parameter in entry["parameters"].values():
        truth = effect["equivalents"].get(parameter["unit"])
        if truth is None:
            continue
        error = (parameter["value"] - truth) / parameter["std_error"]
        if "interval_95" in parameter:
            low, high = parameter["interval_95"]
            return {"error_sigma": error, "covered": low <= truth <= high}
        return {"error_sigma": error, "covered": abs(error) <= GAUSSIAN_95}
    units = ", ".join(str(parameter["unit"]) for parameter in entry["parameters"].values())
    raise ValueError(
        f"{entry['cause']}: no parameter in {', '.join(effect['equivalents'])}, only in {units}; "
        "add the unit to the effect's equivalents"
    )


MRE = ("mre_E_percent", "mre_phase_percent")


def held_out_gain(
    entry: Mapping[str, Any], errors: tuple[str, ...] = MRE, averages: bool = False
) -> float | None:
    """ln of the error before over after, mean of the errors and of all ways to hold out.

    Errors of single tests, or of `averages` over specimens, the mean over temperatures, as in Table 4.
    Above zero is a gain; None where nothing could be held out.
    """
    held_out = entry["gain"]["held_out"]
    if not held_out:
        return None
    parts = [
        _over_temperatures(way["averages_by_temperature"], name) if averages else way[name]
        for way in held_out.values()
        for name in errors
    ]
    return float(np.mean([np.log(part["before"] / part["after"]) for part in parts]))


def _over_temperatures(errors: Mapping[str, Mapping[str, Any]], name: str) -> dict[str, float]:
    return {
        when: float(np.mean([row[name][when] for row in errors.values()])) for when in ("before", "after")
    }


def efficiency(table: pd.DataFrame, ratios: tuple[float, ...] = (1.0, 2.0, 3.0, 5.0)) -> pd.DataFrame:
    """Rate of finding, and of naming among the found, per cause and nearest of `ratios`."""
    single = table[(table["suite"] == "single") & table["ratio"].notna()]
    grid = np.array(ratios)
    nearest = grid[np.abs(np.log(single["ratio"].to_numpy(float)[:, None] / grid)).argmin(axis=1)]
    rows = []
    for (cause, ratio), part in single.groupby(["cause", nearest]):
        found, named = rate(part["found"]), rate(part.loc[part["found"], "named"])
        row = {"cause": cause, "ratio": ratio, "n": found["n"]}
        for what, values in (("found", found), ("named", named)):
            row |= {what: values["rate"], f"{what}_low": values["low"], f"{what}_high": values["high"]}
        rows.append(row)
    return pd.DataFrame(rows)


def isolation_matrix(table: pd.DataFrame) -> pd.DataFrame:
    """Cases by what was hidden (rows: none, one catalogue cause, one outside) and what came out (columns)."""
    alone = table[table["suite"] != "pair"]
    return pd.crosstab(alone["cause"], alone["outcome"])


def summary(table: pd.DataFrame, ratio: float = 3.0) -> dict[str, dict[str, float]]:
    """The figures of merit, each as `rate`.

    found, named: single effects at about `ratio` times the limit, named among the found; false_alarm: empty
    cases with any name; false_structure: empty cases without a name that end as unexplained; outside_*:
    effects beyond the catalogue that end unexplained, with any name, with a name and no doubt, or unseen;
    covered, gained: all causes named by themselves; pair_named: effects of pairs.
    """
    single, empty = table[table["suite"] == "single"], table[table["suite"] == "empty"]
    at_ratio = single[np.abs(np.log(single["ratio"].astype(float) / ratio)) < np.log(1.2)]
    outside = table[table["suite"] == "outside"].drop_duplicates("case")
    confident = outside["confident"] > 0
    unexplained = (outside["verdict"] == UNEXPLAINED) & ~confident
    return {
        "found": rate(at_ratio["found"]),
        "named": rate(at_ratio.loc[at_ratio["found"], "named"]),
        "extra_name": rate(single["wrong"][single["named"]] > 0),
        "false_alarm": rate(empty["wrong"] > 0),
        "false_structure": rate(empty["outcome"] == UNEXPLAINED),
        "outside_unexplained": rate(unexplained),
        "outside_named": rate(outside["wrong"] > 0),
        "outside_confidently_named": rate(confident),
        "outside_unseen": rate(outside["outcome"] == NOTHING),
        "pair_named": rate(table.loc[table["suite"] == "pair", "named"]),
        "covered": rate(table["covered"]),
        "gained": rate(table["gained"]),
    }
