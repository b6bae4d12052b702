"""Phases with the wrong sign, which the rest of their sweep shows.

A table has columns specimen, temperature_C (of the isotherm), frequency_Hz, E_MPa and phase_deg. A delay of the force
makes phases negative too, but in proportion to the frequency, and a stiff mix may scatter about zero.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.words import specimen_named

LEAST = 6.0  # deg below zero that neither scatter nor an offset of a stiff mix is
NEAR = 2.0, 0.2  # deg, or share of the phase expected, within which the phase with its sign changed must come
SCATTER = 0.5  # deg, of the phase of an elastic beam about zero
LEAST_SWEEP = 3  # tests of a sweep

Vector = NDArray[np.float64]


def wrong_sign(table: pd.DataFrame) -> tuple[int, str] | None:
    """Row, from 0, of the first phase whose sign is wrong, and a sentence with the mend; None if there is none.

    The table has specimen, temperature_C (of the isotherm), frequency_Hz, E_MPa and phase_deg.
    """
    rows = table.assign(row=np.arange(len(table))).sort_values("frequency_Hz")
    for (specimen, temperature), tests in rows.groupby(["specimen", "temperature_C"]):
        frequency, phase = tests["frequency_Hz"].to_numpy(float), tests["phase_deg"].to_numpy(float)
        if np.unique(frequency).size < LEAST_SWEEP or not (phase < -LEAST).any():
            continue
        place = f"{specimen_named(str(specimen))} at {temperature:g} degC"
        if (phase < 0.0).all():
            slope = np.polyfit(np.log(frequency), np.log(tests["E_MPa"].to_numpy(float)), 1)[0]
            required = 90.0 * slope  # deg, by Kramers and Kronig to first order
            if _agrees(-float(np.median(phase)), required) and _usual(
                table, tests, "temperature_C", temperature
            ):
                return int(tests["row"].iloc[0]), (
                    f"all phases of {place} are negative (median {np.median(phase):.3g} deg), and the moduli require "
                    f"about +{required:.2g} deg: the signs are wrong; remove the minus signs."
                )
        for test in np.flatnonzero(phase < -LEAST):
            expected = _expected(frequency, phase, int(test))
            alone = _usual(table, tests, "frequency_Hz", frequency[test])
            if expected is not None and _agrees(-float(phase[test]), expected) and alone:
                return int(tests["row"].iloc[test]), (
                    f"the phase at {frequency[test]:g} Hz is {phase[test]:.3g} deg, and the other frequencies of "
                    f"{place} say about +{expected:.3g} deg: the sign is wrong; remove the minus sign."
                )
    return None


def negative_phases(table: pd.DataFrame) -> str:
    """A sentence on the phases below zero of a reduced table, which no passive material has; empty without any."""
    low = table[table["phase_deg"] < -SCATTER]
    if low.empty:
        return ""
    worst = low.loc[low["phase_deg"].idxmin()]
    return (
        f"{len(low)} of {len(table)} phases are below zero, at worst {worst['phase_deg']:.3g} deg "
        f"({specimen_named(str(worst['specimen']))}, {worst['temperature_C']:g} degC, {worst['frequency_Hz']:g} Hz): "
        "no material gives back more than it takes, and a channel that lags does; diagnose says which."
    )


def _usual(table: pd.DataFrame, sweep: pd.DataFrame, column: str, value: float) -> bool:
    """Whether the other sweeps with this `value` in `column` have a median phase above LEAST, or there are none."""
    others = table.drop(index=sweep.index)
    phases = others.loc[others[column] == value, "phase_deg"]
    return phases.empty or bool(phases.median() > LEAST)


def _agrees(turned: float, expected: float) -> bool:
    return expected > LEAST and abs(turned - expected) < max(NEAR[0], NEAR[1] * expected)


def _expected(frequency: Vector, phase: Vector, test: int) -> float | None:
    """Phase [deg] of one test by the positive phases of its sweep: between them and below straight over ln f.

    Above the highest it is straight over f, as a delay of the force goes on, and does not rise. None of fewer than two.
    """
    known = (phase > 0.0) & (frequency != frequency[test])
    at, values = np.unique(frequency[known], return_index=True)
    values = phase[known][values]
    if at.size < 2:
        return None
    if frequency[test] > at[-1]:
        line = (values[-1] - values[-2]) / (at[-1] - at[-2])
        return float(values[-1] + min(line, 0.0) * (frequency[test] - at[-1]))
    if frequency[test] < at[0]:
        line = (values[1] - values[0]) / np.log(at[1] / at[0])
        return float(values[0] + line * np.log(frequency[test] / at[0]))
    return float(np.interp(np.log(frequency[test]), np.log(at), values))
