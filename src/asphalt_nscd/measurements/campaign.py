"""A campaign as it reaches a diagnosis: one table, where it came from, and the isotherms in it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Table

READINGS_APART = 0.5  # K; neighbours in one isotherm are no further apart: T 378 holds +- 0.5 K
WIDEST_ISOTHERM = 1.0  # K between the coldest and the warmest reading of one isotherm
TARGETS_APART = 3.0  # K between two temperatures that a laboratory means to test at
OFF_TARGET = 0.5  # K that T 378 lets the mean temperature of a test stray from its target


@dataclass(frozen=True)
class Campaign:
    """Tests of a campaign in our columns, the files they came from, and sentences on how they were read.

    `test_type` is one of `further_kinds.ALL_KINDS`, or UNKNOWN; `without_tests` has a sentence for each folder some of
    whose files hold no test, and for each table some of whose tests lack a phase. `stated` is what files say for the
    head of a report: mix, project, operator, date, standard.
    """

    table: Table
    files: tuple[Path, ...]
    test_type: str = "bending"
    notes: tuple[str, ...] = field(default=())
    without_tests: tuple[str, ...] = ()
    stated: Mapping[str, str] = field(default_factory=dict)


def isotherms(temperature: NDArray[np.float64], tests: Sequence[Hashable]) -> NDArray[np.float64]:
    """Isotherm of each measured temperature (n,) [degC]: the mean of the isotherm's readings to 0.1 K.

    Neighbouring temperatures at most READINGS_APART apart belong together, unless the isotherm then grew wider than
    WIDEST_ISOTHERM or held one test twice: whoever tested a specimen at 20 and at 20.5 degC at the same frequency meant
    two isotherms. Such temperatures stay as they are. `tests` (n,): what is the same in two rows that repeat each
    other, specimen and frequency.
    """
    values = np.unique(temperature)
    # Readings have a tenth of a degree: 20.0 and 20.5 are 0.5 apart whatever the last bit says.
    groups = np.split(values, np.flatnonzero(np.diff(values) > READINGS_APART + 1e-9) + 1)
    nominal = temperature.copy()
    for group in groups:
        rows = [int(row) for row in np.flatnonzero(np.isin(temperature, group))]
        apart = len({(tests[row], temperature[row]) for row in rows}) > len({tests[row] for row in rows})
        if len(group) > 1 and not apart and group[-1] - group[0] <= WIDEST_ISOTHERM + 1e-9:
            nominal[rows] = round(float(temperature[rows].mean()), 1)
    return nominal


def nominal_temperatures(table: Table, temperature: NDArray[np.float64]) -> NDArray[np.float64]:
    """Isotherm (n,) [degC] of each row of a table: its target where the table gives one, else by `isotherms`.

    A row without a target takes the nearest one within READINGS_APART, else its own temperature. Targets of two
    operators that were held at one temperature are one (`_one_target`).
    """
    names = ("specimen", "replicate", "frequency_Hz", "amplitude_m", "order", "cycles")
    conditions = list(zip(*(table.columns[name] for name in names if name in table.columns), strict=True))
    target = table.numbers_or_nan("nominal_temperature_C")
    told = np.isfinite(target)
    if not told.any():
        return isotherms(temperature, conditions)
    target = _one_target(target, temperature, np.array(table.columns.get("specimen", [""] * target.size)))
    nominal = np.where(told, target, temperature)
    for row in np.flatnonzero(~told):
        targets = np.unique(target[told])
        near = targets[np.abs(targets - temperature[row]) <= READINGS_APART]
        if near.size:
            nominal[row] = near[np.argmin(np.abs(near - temperature[row]))]
    return nominal


def separate_sweeps(nominal: NDArray[np.float64], specimen: NDArray) -> NDArray[np.float64]:
    """Isotherms (n,) [degC]; a sweep at a temperature where its specimen stands alone goes to a near one that it lacks.

    Near is less than TARGETS_APART, and the specimen was tested beside those there at two temperatures more: the record
    of the sweep is wrong, or its bath was. Of two sweeps that stand alone the rounder temperature is the isotherm's.
    """
    out = nominal.copy()
    at = {float(t): set(specimen[nominal == t].tolist()) for t in np.unique(nominal)}

    def rank(t: float) -> tuple[int, int]:
        """How many specimens were tested at a temperature, then how few digits it has."""
        return len(at[t]), -len(f"{t:g}".lstrip("-"))

    for t, own in at.items():
        lacked = [u for u in at if 0.0 < abs(u - t) < TARGETS_APART and not own & at[u]]
        best = max(lacked, key=lambda u: (rank(u), -u), default=t)
        shared = sum(bool(own & there) and bool(at[best] & there) for there in at.values())
        if len(own) == 1 and shared > 1 and (rank(best), -best) > (rank(t), -t):
            out[nominal == t] = best
    return out


def _one_target(
    target: NDArray[np.float64], temperature: NDArray[np.float64], specimen: NDArray[np.str_]
) -> NDArray[np.float64]:
    """Targets (n,) [degC], two of them made one where both were held at one temperature: 20 and 21 in a bath at 21.

    They are at most WIDEST_ISOTHERM apart, their mean readings at most READINGS_APART, and no specimen has both.
    """
    out = target.copy()
    values = np.unique(target[np.isfinite(target)])
    for low, high in zip(values[:-1], values[1:], strict=True):
        below, above = out == low, target == high
        if not below.any() or high - low > WIDEST_ISOTHERM + 1e-9:
            continue
        apart = abs(temperature[below].mean() - temperature[above].mean()) > READINGS_APART + 1e-9
        if not apart and not np.isin(specimen[below], specimen[above]).any():
            both = below | above
            held = temperature[both].mean()
            out[both] = low if abs(held - low) < abs(held - high) else high
    return out


def isotherm_notes(temperature: NDArray[np.float64], nominal: NDArray[np.float64]) -> list[str]:
    """Sentences on isotherms that hold more than one temperature [degC], and on tests off their target."""
    notes = []
    changed = np.unique(nominal[np.abs(temperature - nominal) > 1e-9])
    if changed.size:
        parts = []
        for value in np.unique(nominal):
            measured = temperature[nominal == value]
            readings = f"{measured.min():g} to {measured.max():g}" if np.ptp(measured) else f"{measured[0]:g}"
            parts.append(f"{value:g} (measured {readings})" if value in changed else f"{value:g}")
        notes.append(f"Isotherms in degC: {', '.join(parts)}.")
    off = np.abs(temperature - nominal) > OFF_TARGET + 1e-9
    if off.any():
        worst = int(np.argmax(np.abs(temperature - nominal)))
        notes.append(
            f"More than {OFF_TARGET:g} K off the target temperature (AASHTO T 378): {int(off.sum())} of {off.size} "
            f"tests, at worst {temperature[worst]:g} instead of {nominal[worst]:g} degC."
        )
    return notes
