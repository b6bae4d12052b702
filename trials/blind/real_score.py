"""What a diagnosis found of a cause put into a table that it has diagnosed before, as it was.

Beside what is hidden a table may hold causes of its own, and structure without a name. So a name counts as
false only if the untouched table did not give it, and a size is what it grew by: the table's own value, its
estimate in the untouched table, is taken off. No row holds a value of the table.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import score

Diagnosis = Mapping[str, Any]
Entry = Mapping[str, Any]


def names(diagnosis: Diagnosis, confident: bool = False) -> list[Entry]:
    """Rungs with a name; of the confident ones if asked."""
    rungs = [entry for entry in diagnosis["ladder"] if entry["cause"] != score.TRUE_OF_ALL]
    return [entry for entry in rungs if not confident or score.established(entry, diagnosis)]


def untouched(diagnosis: Diagnosis, odd: str | None = None) -> dict[str, Any]:
    """Row of a table as it is: names that it gives, which are false in a drawn table.

    odd: the specimen that truly differs; that its size is named is no false name, and is counted apart.
    """
    confident = names(diagnosis, confident=True)
    of_odd = [entry for entry in confident if _is_odd(entry, odd)]
    return _state(diagnosis) | {
        "cause": score.NOTHING,
        "any_name": len(names(diagnosis)),
        "wrong": len(confident) - len(of_odd),
        "odd_named": bool(of_odd) if odd else None,
        "wrong_names": _told(confident, of_odd),
    }


def row(
    effect: Mapping[str, Any],
    unit: str,
    limit: float,
    before: Diagnosis,
    after: Diagnosis,
    odd: str | None = None,
    alike: Diagnosis | None = None,
) -> dict[str, Any]:
    """Row of one effect. limit: its detection limit [unit] stated for the table as it was; odd: as of `untouched`.

    alike: that of the untouched table on the tests that the later one used and without causes that it does not name;
    `before` if None.

    named: by some rung, in the right place or in a group that cannot be told apart; established: with confidence;
    covered: whether the size grew by what was put in, within its 95 % interval; covered_alike: the same over its
    size there, for a table's own size may hang on tests that are no longer left out, and on a cause that it names
    instead; added: confident
    names that are not true and were not there before; instead: such a name, and not the right one; own_over_limit:
    the table's own value.
    """
    telling = [entry for entry in names(after) if score.tells(entry, effect, after)]
    confident = names(after, confident=True)
    known = {_key(entry) for entry in names(before)}
    false = [e for e in confident if not score.tells(e, effect, after) and not _is_odd(e, odd)]
    added = [entry for entry in false if _key(entry) not in known]
    own = _estimate(before, effect, unit)
    found = _estimate(after, effect, unit)
    result = _state(after) | {
        "named": bool(telling),
        "established": any(entry in confident for entry in telling),
        "named_before": any(score.tells(entry, effect, before) for entry in names(before)),
        "elsewhere": not telling and any(entry["cause"] == effect["cause"] for entry in confident),
        "added": len(added),
        "instead": bool(added) and not telling,
        "wrong_names": _told(added),
        "own_over_limit": np.nan if own is None else abs(own[0]) / limit,
        "covered": None,
        "error_sigma": np.nan,
        "covered_alike": None,
        "error_sigma_alike": np.nan,
    }
    if telling and found is not None and found[1]:
        same = own if alike is None else _estimate(alike, effect, unit)
        for name, taken_off in (("", own), ("_alike", same)):
            missing = found[0] - (taken_off[0] if taken_off else 0.0) - effect["equivalents"][unit]
            low, high = (bound - found[0] for bound in found[2])
            result[f"error_sigma{name}"] = missing / found[1]
            result[f"covered{name}"] = bool(low <= -missing <= high)
    return result


def left_out(diagnosis: Diagnosis) -> frozenset[tuple[str, float, float]]:
    """Tests that a diagnosis did not use: specimen, isotherm [degC], frequency [Hz]."""
    suspects = (one for one in diagnosis.get("suspect_tests", []) if not one["used"])
    return frozenset((one["specimen"], one["temperature_C"], one["frequency_Hz"]) for one in suspects)


def _state(diagnosis: Diagnosis) -> dict[str, Any]:
    return {
        "verdict": diagnosis["verdict"],
        "failed": diagnosis["verdict"] == "failed",
        "error": diagnosis.get("error", ""),
        "cpu_s": diagnosis["cpu_s"],
    }


def _is_odd(entry: Entry, odd: str | None) -> bool:
    """Whether a name says of the specimen that truly differs that its size is another."""
    return entry["cause"] == "specimen_geometry" and odd is not None and str(entry["where"]) == odd


def _key(entry: Entry) -> tuple[str, str]:
    return entry["cause"], str(entry.get("where"))


def _told(entries: list[Entry], but: list[Entry] | None = None) -> str:
    """Causes without their places, which belong to the table."""
    return " ".join(sorted(entry["cause"] for entry in entries if entry not in (but or [])))


def _estimate(
    diagnosis: Diagnosis, effect: Mapping[str, Any], unit: str
) -> tuple[float, float, tuple[float, float]] | None:
    """Value, standard error and 95 % interval of a cause at a place, named or not; None where none is given."""
    for entry in names(diagnosis):
        if not score.is_same(entry, effect):
            continue
        for parameter in entry["parameters"].values():
            if parameter["unit"] == unit:
                return _value(parameter)
    places = diagnosis.get("estimates", {}).get(effect["cause"], {}).get("places", {})
    for place, estimate in places.items():
        where = None if effect["where"] is None else place
        if score.is_same({"cause": effect["cause"], "where": where}, effect) and estimate["unit"] == unit:
            return _value(estimate)
    return None


def _value(estimate: Mapping[str, Any]) -> tuple[float, float, tuple[float, float]]:
    value, error = float(estimate["value"]), float(estimate["std_error"] or 0.0)
    half = score.GAUSSIAN_95 * error
    return value, error, tuple(estimate.get("interval_95") or (value - half, value + half))
