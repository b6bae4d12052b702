"""Result tables as figures and tables read them: checked, and averaged over samples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.reduction import read_reduced

KEYS = ["temperature_C", "frequency_Hz"]
MODULUS = ["E_MPa", "phase_deg"]
OF_THE_LAW = ["E_law_MPa", "phase_law_deg"]
SAME_TEMPERATURE = 1e-6  # K


def read_tests(
    paths: Sequence[str | Path], numbers: Sequence[str] = (), texts: Sequence[str] = ()
) -> pd.DataFrame:
    """Tables of simulated tests put together: specimen, KEYS, MODULUS, OF_THE_LAW and the further columns named."""
    frames = []
    for path in _given(paths):
        table = read_csv(path)
        texts_wanted, numbers_wanted = ["specimen", *texts], [*KEYS, *MODULUS, *OF_THE_LAW, *numbers]
        table.require([*texts_wanted, *numbers_wanted])
        columns = {name: table.text(name) for name in texts_wanted}
        frames.append(pd.DataFrame(columns | {name: table.numbers(name) for name in numbers_wanted}))
    return pd.concat(frames, ignore_index=True)


def read_measured(paths: Sequence[str | Path]) -> pd.DataFrame:
    """Reduced tables of measurements put together, one row for each test."""
    return pd.concat([read_reduced(path) for path in _given(paths)], ignore_index=True)


def origin_of(measured: pd.DataFrame) -> str:
    """What the measurements are, in a word for legends: "measured", "reconstructed", or several."""
    return " and ".join(sorted(measured["origin"].unique()))


def averages(frame: pd.DataFrame, by: Sequence[str] = KEYS, columns: Sequence[str] = MODULUS) -> pd.DataFrame:
    """Means of `columns` over samples of a point, standard deviations `<column>_sd` (NaN for one sample) and count."""
    groups = frame.groupby(list(by))[list(columns)]
    # Of a sample, so NaN for a single one: zero would say that it scatters by nothing.
    spread = groups.std(ddof=1).add_suffix("_sd")
    return groups.mean().join(spread).join(groups.size().rename("count")).reset_index()


def isotherm_rows(frame: pd.DataFrame, temperature: float) -> pd.DataFrame:
    """Rows of one temperature [degC]; refuses a table that has none."""
    rows = frame[np.abs(frame["temperature_C"] - temperature) < SAME_TEMPERATURE]
    if rows.empty:
        available = ", ".join(f"{value:g}" for value in sorted(frame["temperature_C"].unique()))
        raise InputError(f"no test at {temperature:g} degC; the table has {available}.")
    return rows


def only_file(paths: Iterable[str | Path], kind: str) -> Path:
    """The single path given for a `kind` of data; InputError for none or several."""
    paths = list(paths)
    if len(paths) != 1:
        raise InputError(f"{len(paths)} files given as {kind!r}; give exactly one.")
    return Path(paths[0])


def _given(paths: Sequence[str | Path]) -> Sequence[str | Path]:
    if not paths:
        raise InputError("no table given; give at least one.")
    return paths
