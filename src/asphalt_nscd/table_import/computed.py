"""Specimens computed of the others, known by their numbers in any language: mean, median, deviation or CV."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.measurements.campaign import nominal_temperatures
from asphalt_nscd.measurements.units import MEGAPASCAL

LEAST = 4  # tests that must agree
APART = (
    4.0  # times the rounding: measured specimens must differ by more in most tests, or agreement says nothing
)
_UNITS = {"E_MPa": tuple(MEGAPASCAL.values()), "phase_deg": (1.0, 180.0 / np.pi)}


def computed_specimens(table: Table) -> list[str]:
    """Specimens whose every |E*| and phase is one statistic of the specimens before them, or behind them."""
    if "E_MPa" not in table.columns or "replicate" in table.columns:
        return []
    names = [name for name in _UNITS if name in table.columns]
    frame = pd.DataFrame({name: table.numbers_or_nan(name) for name in (*names, "frequency_Hz")})
    frame["t"] = nominal_temperatures(table, table.numbers_or_nan("temperature_C"))
    frame["specimen"] = table.text("specimen")
    specimens = list(dict.fromkeys(frame["specimen"]))
    if len(specimens) < 3 or frame.duplicated(["specimen", "t", "frequency_Hz"]).any():
        return []
    wide = frame.pivot(index=["t", "frequency_Hz"], columns="specimen", values=names)
    steps = {name: [_step(wide[name][one].to_numpy(), _UNITS[name]) for one in specimens] for name in names}
    for count in range(len(specimens) - 1, 1, -1):
        for measured, others in (
            (specimens[:count], specimens[count:]),
            (specimens[-count:], specimens[:-count]),
        ):
            if all(_is_computed(wide, steps, specimens, measured, one) for one in others):
                return others
    return []


def _is_computed(
    wide: pd.DataFrame, steps: dict[str, list[float]], specimens: list[str], measured: list[str], one: str
) -> bool:
    """Whether |E*| and phase of a specimen are statistics of those of the measured ones."""
    told = False
    for name, step in steps.items():
        given = wide[name][measured].to_numpy()
        own = wide[name][one].to_numpy()
        shared = np.isfinite(own) & np.isfinite(given).all(axis=1)
        if not np.isfinite(own).any():
            continue  # a CV that only |E*| has
        rounding = max(step[specimens.index(other)] for other in measured)
        if shared.sum() < LEAST or not _agrees(
            own[shared], given[shared], step[specimens.index(one)], rounding, _UNITS[name]
        ):
            return False
        told = told or bool(np.median(np.ptp(given[shared], axis=1)) > APART * rounding)
    return told


def _agrees(
    own: NDArray[np.float64],
    given: NDArray[np.float64],
    own_step: float,
    rounding: float,
    units: Sequence[float],
) -> bool:
    """Whether numbers (n,) are the mean, median, deviation or CV of those given (n, specimens), as they are rounded."""
    mean, slack = given.mean(axis=1), 0.51 * (own_step + rounding) + 1e-9 * np.abs(own).max()
    if (np.abs(own - mean) <= slack).all() or (np.abs(own - np.median(given, axis=1)) <= slack).all():
        return True
    deviations = [given.std(axis=1, ddof=ddof) for ddof in (0, 1)]
    if any((np.abs(own - deviation) <= slack + 0.5 * rounding).all() for deviation in deviations):
        return True
    # A CV stands in a column that has a unit, which was converted with it.
    return any(
        (
            np.abs(own / unit - share * deviation / mean)
            <= 0.51 * own_step / unit + 2.0 * share * rounding / np.abs(mean)
        ).all()
        for deviation in deviations
        for share in (1.0, 100.0)
        for unit in units
    )


def _step(values: NDArray[np.float64], units: Sequence[float]) -> float:
    """Coarsest decimal step, in one of the units, that divides all values: twice their rounding; 0 if none does."""
    values = values[np.isfinite(values)]
    steps = sorted((unit * 10.0**-digits for unit in units for digits in range(7)), reverse=True)
    # a CV of 0.05 is no multiple of a GPa, though nearly none of it
    largest = np.abs(values).max(initial=0.0)
    return next(
        (
            step
            for step in steps
            if step <= largest and np.allclose(values / step, np.round(values / step), rtol=0, atol=1e-4)
        ),
        0.0,
    )
