"""How far simulation lies from measurement, as Table 4 puts it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError

KEYS = ["temperature_C", "frequency_Hz"]


def mean_relative_error(
    measured: pd.DataFrame,
    simulated: pd.DataFrame,
    least_phase_deg: float = 0.0,
    by: Sequence[str] = KEYS,
) -> pd.DataFrame:
    """Mean relative error of |E*| and phase [%] for each temperature (Table 4).

    As in the paper, the average over specimens is compared with that over samples, point by point, relative to the
    measurement; the mean is over the frequencies that were simulated. A measured phase below `least_phase_deg`, of an
    elastic reference beam say, is nothing to divide by: the error is relative to `least_phase_deg` there. `by` names
    the columns of a point: temperature_C, frequency_Hz, and what else tests differ by on purpose.
    """
    columns = ["E_MPa", "phase_deg"]
    experiment = measured.groupby(list(by))[columns].mean()
    simulation = simulated.groupby(list(by))[columns].mean()
    for temperature, frequency, *_ in simulation.index.difference(experiment.index):
        raise InputError(f"no measurement at {temperature:g} degC, {frequency:g} Hz to compare with; add it.")
    if simulation.empty:
        raise InputError("the table of simulations is empty; simulate at least one test.")
    experiment = experiment.loc[simulation.index]
    # A delayed channel may turn a phase below zero; the error is relative to its size.
    size = experiment.abs()
    size["phase_deg"] = size["phase_deg"].clip(lower=least_phase_deg)
    errors = 100.0 * np.abs(simulation - experiment) / size
    errors.columns = ["mre_E_percent", "mre_phase_percent"]
    return errors.groupby("temperature_C").mean().reset_index()
