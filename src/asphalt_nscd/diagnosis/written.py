"""A diagnosis as it was written: what figures and report read of diagnosis.json, residuals.csv, causality.csv."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from msgspec import ValidationError

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.content.whole import Content, checked
from asphalt_nscd.diagnosis.criteria import CONFIDENCE, WIDE_SPREAD
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.files.words import specimen_named, three_digits
from asphalt_nscd.measurements.tables import averages, only_file

SCHEMA_VERSION = 3
CONFINED_TO = {cause.name: cause.confined_to for cause in CATALOGUE}
UNITS = {cause.name: cause.parameters[0].unit for cause in CATALOGUE}  # of amplitudes
BEFORE_AFTER = ("before", "after")
# Of a rung of the ladder that is no cause in the tests: what only those have.
NO_CAUSE: dict[str, Any] = {
    "where": None,
    "log10_shift": {},
    "probability": None,
    "as_good": [],
    "taken_off": 0.0,
    "hangs_on": [],
    "doubts": [],
    "evidence": "",
}
RESIDUALS = {"E": "residual_E_{}_percent", "phase": "residual_phase_{}_deg"}
_TEST = ["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
_FITTED = ["E_{}_MPa", "phase_{}_deg", *RESIDUALS.values()]
_NUMBERS = _TEST + [column.format(when) for when in BEFORE_AFTER for column in _FITTED]
_SHOWN = {
    "s": (1e3, "ms"),
    "Pa": (1e-6, "MPa"),
    "1/Pa": (1e12, "1/TPa"),
    "kg": (1e3, "g"),
    "deg": (1.0, "°"),
    "degC": (1.0, "°C"),
    "1": (100.0, "%"),
    "-": (1.0, ""),  # an exponent
}


def read_diagnosis(paths: Sequence[Path]) -> Content:
    """Read the one diagnosis.json and check its version and types."""
    path = only_file(paths, "diagnosis")
    content = read_json(path)
    version = content.get("schema_version") if isinstance(content, dict) else None
    if version != SCHEMA_VERSION:
        raise InputError(f"{path}: not a diagnosis of version {SCHEMA_VERSION}; make it with `diagnose`.")
    try:
        return checked(content)
    except ValidationError as error:
        raise InputError(f"{path}: damaged ({error}); delete it and run `diagnose` again.") from None


def read_residuals(paths: Sequence[Path]) -> pd.DataFrame:
    """Read the one residuals.csv: each test measured and simulated, before and after, and what lies between.

    NaN before is a condition that the study did not simulate.
    """
    table = read_csv(only_file(paths, "residuals"))
    table.require(["specimen", *_NUMBERS])
    numbers = {
        name: table.numbers_or_nan(name) if "_before_" in name else table.numbers(name) for name in _NUMBERS
    }
    return pd.DataFrame({"specimen": table.text("specimen")} | numbers)


def read_causality(paths: Sequence[Path]) -> pd.DataFrame:
    """Read the one causality.csv: each test's phase, that which |E*| requires (NaN: not judged), what is suspect."""
    table = read_csv(only_file(paths, "causality"))
    required, error = "phase_required_deg", "std_error_deg"
    table.require(["specimen", *_TEST, required, error, "quality_flag", "status", "reasons"])
    return pd.DataFrame(
        {
            "specimen": table.text("specimen"),
            "status": table.text("status"),
            "reasons": table.columns["reasons"],
        }
        | {name: table.numbers(name) for name in _TEST}
        | {name: table.numbers_or_nan(name) for name in (required, error)}
        | {"quality_flag": table.numbers("quality_flag") > 0.0}
    )


def conditions(residuals: pd.DataFrame, scatter: Mapping[str, Any]) -> pd.DataFrame:
    """Means over specimens by temperature and frequency.

    `scatter` is that of one test; the column `z_<column>` of a residual is its mean over the standard deviation of that
    mean.
    """
    means = averages(residuals, columns=_NUMBERS[2:])
    for quantity, sigma in (("E", scatter["modulus_percent"]), ("phase", scatter["phase_deg"])):
        for when in BEFORE_AFTER:
            column = RESIDUALS[quantity].format(when)
            # A mean over specimens scatters by the root of their number less.
            means[f"z_{column}"] = means[column] / sigma * np.sqrt(means["count"])
    return means


def mean_averages(gain: Mapping[str, Any], inner: bool = False) -> dict[str, dict[str, float]]:
    """Errors of |E*| and phase before and after [%], as in Table 4, and of the phase [deg], mean over temperatures.

    `inner` leaves out the coldest and the warmest, unless they are all: an end that is left out of a fit is
    extrapolated.
    """
    at = sorted(gain["averages_by_temperature"], key=float)
    there = [gain["averages_by_temperature"][t] for t in ((inner and at[1:-1]) or at)]
    return {
        name: {when: sum(errors[name][when] for errors in there) / len(there) for when in BEFORE_AFTER}
        for name in ("mre_E_percent", "mre_phase_percent", "off_phase_deg")
    }


def shown(value: float, unit: str) -> tuple[float, str]:
    """A value and its unit as people use them for its size: 2.9e-5, "s" -> 0.029, "ms"."""
    factor, name = _SHOWN.get(unit, (1.0, unit))
    return factor * value, name


def interval_text(value: float, half: float) -> str:
    """A value and its interval to the second digit of the interval.

    >>> interval_text(0.739, 1.08), interval_text(3.0, 0.392), interval_text(-227.4, 268.0)
    ('0.7 +- 1.1', '3.00 +- 0.39', '-230 +- 270')
    """
    return f"{round_to_interval(value, half)} +- {round_to_interval(half, half) if half > 0.0 else 0}"


def round_to_interval(value: float, half: float) -> str:
    """A value to the second digit of half of its interval.

    >>> round_to_interval(0.739, 1.08), round_to_interval(-227.4, 268.0), round_to_interval(0.739, 0.0)
    ('0.7', '-230', '0.739')
    """
    if not half > 0.0:
        return three_digits(value)
    digits = 1 - int(f"{half:.1e}".partition("e")[2])
    return f"{round(value, digits) + 0.0:.{max(digits, 0)}f}"


def widening(spread: float) -> float:
    """Factor, 1 at least, on intervals and limits where tests lie far from the fit; see `Ladder.estimates_spread`."""
    return spread if spread >= WIDE_SPREAD else 1.0


def interval_95(value: float, error: float, factor: float = 1.0, of_logarithm: bool = False) -> list[float]:
    """Ends (2,) of the 95 % interval of an estimate with a standard error, in the unit of the value.

    `factor` is that of `widening`; with `of_logarithm` it is the logarithm that is so uncertain.

    >>> interval_95(1.0, 0.5)
    [0.020000000000000018, 1.98]
    >>> [round(end, 3) for end in interval_95(2.0, 1.0, of_logarithm=True)]
    [0.751, 5.329]
    """
    if of_logarithm:
        # To first order the logarithm errs by error / value; so taken, no interval reaches zero.
        ratio = float(np.exp(factor * CONFIDENCE * error / value))
        return [value / ratio, value * ratio]
    return [value - factor * CONFIDENCE * error, value + factor * CONFIDENCE * error]


def cause_at(cause: str, place: object) -> str:
    """A cause and its place in words: `temperature bias at 30 degC`, `loose clamp of specimen 2`."""
    words = cause.replace("_", " ")
    if place is None:
        return words
    return (
        f"{words} at {place:g} degC"
        if isinstance(place, float)
        else f"{words} of {specimen_named(str(place))}"
    )


def name_at(cause: str, place: object) -> str:
    """`cause @ place`, or `cause` alone for all tests (None); a place is a specimen or an isotherm [degC]."""
    return cause if place is None else f"{cause} @ {place}"
