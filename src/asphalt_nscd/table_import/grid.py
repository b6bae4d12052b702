"""Which temperatures and frequencies a study takes: it simulates every one of them with every other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError

LEAST_TEMPERATURE_STEP = 0.5  # K; two set temperatures differ by more, two readings of one by less
LEAST_FREQUENCY_STEP = 0.02  # relative


def grid(frame: pd.DataFrame, path: Path) -> tuple[list[float], list[float], list[str]]:
    """Temperatures [degC] and frequencies [Hz] of the largest full grid, and notes on the tests outside it.

    Its frequencies are those of one temperature or those that all have; larger grids of others are not sought.
    """
    temperatures, frequencies = (np.unique(frame[name]) for name in ("temperature_C", "frequency_Hz"))
    _require_apart(temperatures, np.diff(temperatures) < LEAST_TEMPERATURE_STEP, "temperatures", "degC", path)
    near = np.diff(frequencies) < LEAST_FREQUENCY_STEP * frequencies[:-1]
    _require_apart(frequencies, near, "frequencies", "Hz", path)
    tested = {t: set(frame.loc[frame["temperature_C"] == t, "frequency_Hz"]) for t in temperatures}
    sets = [*tested.values(), set.intersection(*tested.values())]
    blocks = [([t for t in temperatures if wanted <= tested[t]], sorted(wanted)) for wanted in sets if wanted]
    kept_t, kept_f = max(blocks, key=lambda block: len(block[0]) * len(block[1]))
    for t in kept_t:
        if len(tested[t]) < 2:
            raise InputError(
                f"{path}: only one frequency at {t:g} degC, but a Burgers law needs two; measure more or remove it."
            )
    outside = len(frame) - int(
        (frame["temperature_C"].isin(kept_t) & frame["frequency_Hz"].isin(kept_f)).sum()
    )
    notes = []
    if outside:
        notes.append(
            f"{outside} of {len(frame)} tests are not simulated, because every temperature is simulated at every "
            "frequency and theirs are not complete; the diagnosis takes them all"
        )
    return [float(t) for t in kept_t], [float(f) for f in kept_f], notes


def _require_apart(values: np.ndarray, near: np.ndarray, what: str, unit: str, path: Path) -> None:
    """Refuse values (n,), ascending, of which neighbours are `near` (n - 1,)."""
    if near.any():
        place = int(np.flatnonzero(near)[0])
        raise InputError(
            f"{path}: {what} {values[place]:g} and {values[place + 1]:g} {unit} are probably one set value; "
            "give that value in all rows."
        )
