"""What an answer says of what was put in: rightly, wrongly, with confidence or as possible, removed or kept.

A name is an entry of the ladder but the law. It is confident if `established`, else possible. It is right if it is the
fault's own, in its place and of its sign, or shares a group with it that the answer calls indistinguishable. Faults
that the catalogue lacks are told by other lists of the answer too; which, is said in `told`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .faults import CATALOGUE, UNITS, Fault
from .laboratory import Campaign
from .plan import Case

Content = Mapping[str, Any]
LAW = ("relaxation_spectrum", "bond_mapping")
NEAR = 2.5  # K: an isotherm may be given by its mean
HALF = 0.5  # of the tests that a fault hits must be flagged for it to be told by its tests
# Names of causes under which a fault outside the first catalogue counts as told, in its own place.
SAME = {
    "offset of one specimen": ("phase_offset", "specimen_offset"),
    "delay of one specimen": ("channel_delay", "specimen_delay"),
    "offset of one isotherm": ("phase_offset", "isotherm_offset"),
    "low-pass filter": ("channel_delay", "low_pass_filter"),  # a delay to first order
    "resonance": ("resonance", "rig_resonance"),
    "zero drift": ("zero_drift",),
    "gain with temperature": ("gain_with_temperature", "vertical_shift"),
    "aliasing": ("aliasing", "wrong_frequency", "top_frequency"),
    "wrong top frequency": ("aliasing", "wrong_frequency", "top_frequency"),
}


def names(content: Content) -> list[Mapping[str, Any]]:
    return [entry for entry in content["ladder"] if entry["cause"] not in LAW]


def right(entry: Mapping[str, Any], fault: Fault, content: Content) -> bool:
    """Whether a name tells the fault: its cause, place and sign, or a group that cannot be told apart."""
    if _is(entry["cause"], entry.get("where"), fault):
        return fault.kind not in CATALOGUE or _value(entry) * fault.size > 0.0
    for group in content.get("indistinguishable", []):
        members = [_member(text) for text in group]
        mine = any(cause == entry["cause"] and _same(where, entry.get("where")) for cause, where in members)
        if mine and any(_is(cause, where, fault) for cause, where in members):
            return True
    return False


def _value(entry: Mapping[str, Any]) -> float:
    """Of the amplitude."""
    return float(next(iter(entry["parameters"].values()))["value"])


def _is(cause: str, where: Any, fault: Fault) -> bool:
    hit = cause == fault.kind if fault.kind in CATALOGUE else cause in SAME.get(fault.kind, ())
    own = fault.specimen if fault.specimen is not None else fault.temperature
    return hit and _same(where, own)


def _same(one: Any, other: Any) -> bool:
    if one is None or other is None:
        return one is other
    try:
        return abs(float(one) - float(other)) < NEAR
    except ValueError:
        return str(one) == str(other)


def _member(text: str) -> tuple[str, str | None]:
    cause, at, where = text.partition(" @ ")
    return cause, where if at else None


def told(fault: Fault, campaign: Campaign, content: Content, answer: str) -> bool:
    """Whether the answer says the fault, by a name or by its lists of what is odd, in the fault's place."""
    if content["verdict"] == "refused":
        return True  # in one sentence that says where to look
    if any(right(entry, fault, content) for entry in names(content)):
        return True
    reading = content.get("reading", {})
    suspects = content.get("suspect_tests", [])
    flagged = [_key(one) for one in suspects if "its own isotherm" in one["decided_by"]]
    rows = fault.rows(campaign)
    if fault.kind in ("exchanged specimens", "copied block"):
        rows = rows | campaign.at(str(fault.other), fault.temperature)
    if fault.kind == "exchanged isotherms":
        rows = rows | campaign.at(fault.specimen, float(fault.other or 0.0))
    if fault.kind in ("offset of one specimen", "delay of one specimen"):
        odd = content.get("odd_phases", [])
        own = [one["temperature_C"] for one in odd if one["specimen"] == fault.specimen]
        return None in own or len(own) >= HALF * len(campaign.isotherms)
    if fault.kind in ("temperature of one specimen on one isotherm", "wrong recorded temperature"):
        odd = [*content.get("odd_temperatures", []), *reading.get("off_target", [])]
        return any(_sweep(one, fault) for one in odd)
    if fault.kind == "offset of one isotherm":
        odd = content.get("contradictory_isotherms", [])
        return any(_same(one["temperature_C"], fault.temperature) for one in odd)
    if fault.kind == "copied block":
        spoken = " ".join([answer, *content.get("notes", []), *reading.get("notes", [])]).lower()
        if any(word in spoken for word in ("identical", "same digits", "copied")):
            return True
    if fault.kind in ("aliasing", "wrong top frequency") and content.get("highest_frequency") is not None:
        return True
    hit = [any(_test(one, test) for one in flagged) for test in campaign.tests[rows].itertuples()]
    whole = fault.kind.startswith("exchanged") and _both_odd(fault, content)
    return whole or bool(rows.sum() < len(rows) and np.mean(hit) >= HALF)


def _said(answer: str) -> bool:
    """Whether an answer holds a certain cause: a fault of the tests, or an effect of the mix."""
    return "\nEffect " in answer or not ("None found" in answer or "None is certain" in answer)


def _sweep(one: Mapping[str, Any], fault: Fault) -> bool:
    return one["specimen"] == fault.specimen and _same(one["temperature_C"], fault.temperature)


def _both_odd(fault: Fault, content: Content) -> bool:
    """Both sweeps are told to be off their level or temperature."""
    ends = [(fault.specimen, fault.temperature), (fault.other, fault.temperature)]
    if fault.kind == "exchanged isotherms":
        ends[1] = (fault.specimen, fault.other)
    odd = [one for key in ("odd_levels", "odd_temperatures") for one in content.get(key, [])]
    return all(any(one["specimen"] == s and _same(one["temperature_C"], t) for one in odd) for s, t in ends)


def _key(one: Mapping[str, Any]) -> tuple[str, float, float]:
    return one["specimen"], one["temperature_C"], one["frequency_Hz"]


def _test(one: tuple[str, float, float], test: Any) -> bool:
    same = one[0] == test.specimen and _same(one[1], test.temperature_C)
    return same and bool(np.isclose(one[2], test.frequency_Hz, rtol=0.01))


def judged(
    campaign: Campaign, case: Case, content: Content, answer: str, before: Sequence[tuple[str, str]] = ()
) -> list[dict[str, Any]]:
    """A row for each fault of a case, one for none. before: names of a measured table as it is, which are not new."""
    given = [e for e in names(content) if (e["cause"], str(e.get("where"))) not in before]
    false = [e for e in given if not any(right(e, fault, content) for fault in case.faults)]
    removed = [_key(one) for one in content.get("suspect_tests", []) if one["status"] == "left out"]
    bad = np.zeros(len(campaign.tests), bool)
    for fault in case.faults:
        bad |= fault.rows(campaign) if case.suite == "slip" else False
    gone = np.array([any(_test(one, test) for one in removed) for test in campaign.tests.itertuples()])
    excused = bad if campaign.broken is None else bad | campaign.at(None, campaign.broken)
    contradictory = [one["temperature_C"] for one in content.get("contradictory_isotherms", [])]
    confident = [e for e in names(content) if e.get("established")]
    common = {
        "table": campaign.name, "bench": campaign.bench, "measured": "measured" in campaign.about,
        "isotherms": len(campaign.isotherms), "suite": case.suite, "ratio": case.ratio, "verdict": content["verdict"],
        "wrong_confident": sum(bool(e.get("established")) for e in false),
        "wrong_possible": sum(not e.get("established") for e in false),
        "wrong_names": " ".join(_label(e) for e in false),
        "hold_zero": sum(_holds_zero(e) for e in names(content)),
        "unsaid": bool(confident) and not _said(answer),
        "good_rejected": int((gone & ~excused).sum()),
        "broken": campaign.broken is not None,
        "broken_found": campaign.broken is not None and _broken_found(campaign, contradictory, gone),
        "broken_false": any(campaign.broken is None or not _same(t, campaign.broken) for t in contradictory),
        "cpu_s": content.get("cpu_s"),
    }  # fmt: skip
    return [common | _of(fault, campaign, case, content, answer, gone) for fault in case.faults or (None,)]


def _broken_found(campaign: Campaign, contradictory: Sequence[float], gone: np.ndarray) -> bool:
    hot = campaign.at(None, campaign.broken)
    return any(_same(t, campaign.broken) for t in contradictory) or bool(gone[hot].mean() >= HALF)


def _of(
    fault: Fault | None, campaign: Campaign, case: Case, content: Content, answer: str, gone: np.ndarray
) -> dict[str, Any]:
    """What is said of one fault."""
    if fault is None:
        return {"fault": "nothing"}
    telling = [entry for entry in names(content) if right(entry, fault, content)]
    row = {
        "fault": fault.kind, "size": fault.size, "unit": UNITS.get(fault.kind, ""),
        "place": str(fault.specimen or "") + ("" if fault.temperature is None else f" {fault.temperature:g} degC"),
        "named": bool(telling), "confident": any(bool(e.get("established")) for e in telling),
        "told": told(fault, campaign, content, answer),
    }  # fmt: skip
    if case.suite == "slip" and fault.kind != "wrong recorded temperature":
        row["removed"] = content["verdict"] == "refused" or bool(gone[fault.rows(campaign)].all())
    itself = [e for e in telling if _is(e["cause"], e.get("where"), fault)]  # not by a group
    # A filter that is told as a delay has another unit.
    if itself and fault.kind in CATALOGUE and "measured" not in campaign.about:
        parameter = next(iter(itself[0]["parameters"].values()))
        low, high = _interval(parameter)
        # The chamber's own error at an isotherm is part of what a temperature bias is.
        warmer = campaign.warmer[fault.rows(campaign)].mean() if fault.kind == "temperature_bias" else 0.0
        truth, error = fault.size + warmer, parameter["std_error"]
        row["covered"] = bool(low <= truth <= high)
        row["error_sigma"] = (parameter["value"] - truth) / error if error else None
    return row


def _interval(parameter: Mapping[str, Any]) -> tuple[float, float]:
    half = 1.96 * (parameter["std_error"] or 0.0)
    low, high = parameter.get("interval_95") or (parameter["value"] - half, parameter["value"] + half)
    return low, high


def _holds_zero(entry: Mapping[str, Any]) -> bool:
    low, high = _interval(next(iter(entry["parameters"].values())))
    return low <= 0.0 <= high


def _label(entry: Mapping[str, Any]) -> str:
    return entry["cause"] + ("!" if entry.get("established") else "")


def stated(
    campaign: Campaign, case: Case, content: Content, before: Sequence[tuple[str, str]] = ()
) -> list[dict[str, Any]]:
    """A row for each name with the probability that the answer gives it, if it gives one, and whether it is right."""
    return [
        {
            "table": campaign.name, "suite": case.suite, "cause": entry["cause"],
            "established": bool(entry.get("established")), "probability": entry.get("probability"),
            "right": any(right(entry, fault, content) for fault in case.faults),
        }
        for entry in names(content) if (entry["cause"], str(entry.get("where"))) not in before
    ]  # fmt: skip
