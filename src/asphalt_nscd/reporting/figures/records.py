"""Histories of a test, cut for plotting."""

from __future__ import annotations

import numpy as np

from asphalt_nscd.files.store import Record


def last_cycle(record: Record) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The last whole cycle of a test: time from its start [s], displacement [m] and force [N]."""
    time, frequency = record.arrays["time_s"], record.attributes["frequency_Hz"]
    # The first time is one step after rest. A cycle that is no multiple of it may lack half a step at its end.
    step = time[0]
    whole = np.floor((time[-1] + step) * frequency)
    start = (whole - 1.0) / frequency
    taken = (time > start - 1e-9 * step) & (time < start + 1.0 / frequency + 1e-9 * step)
    return time[taken] - start, record.arrays["displacement_m"][taken], record.arrays["force_N"][taken]
