"""Fig. 7: displacement imposed at the head and the force it takes, over the last cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.records import last_cycle


@style.journal
def draw(test: list[Path]) -> Figure:
    """Draw displacement and force over the last cycle of a test; amplitudes and lag are those of the harmonic fit."""
    record = load(only_file(test, "test"), "test")
    frequency = record.attributes["frequency_Hz"]
    time, displacement, force = last_cycle(record)
    history = record.arrays["time_s"], record.arrays["force_N"], record.arrays["displacement_m"]
    response = harmonic_response(*history, frequency, cycles=1)
    figure, (upper, lower) = style.new_figure(style.SINGLE, 84.0, rows=2, sharex=True)
    upper.plot(1e3 * time, 1e6 * displacement, color=style.ORANGE)
    lower.plot(1e3 * time, force, color=style.BLUE)
    upper.set_ylabel("displacement (µm)")
    lower.set_ylabel("force (N)")
    lower.set_xlabel("time in the last cycle (ms)")
    lower.set_xlim(0.0, 1e3 / frequency)
    # The force leads, so its crest comes first.
    displaced = 1e3 * time[np.argmax(displacement)]
    crest = displaced - 1e3 * response.phase / (2.0 * np.pi * frequency)
    for axes, values, words in (
        (upper, 1e6 * displacement, f"$z_0$ = {1e6 * response.displacement_amplitude:.3g} µm"),
        (lower, force, f"$F_0$ = {response.force_amplitude:.3g} N"),
    ):
        axes.set_ylim(*(1.25 * np.abs(values).max() * np.array([-1.0, 1.0])))
        axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
        for at, colour in ((crest, style.BLUE), (displaced, style.ORANGE)):
            axes.axvline(at, color=colour, lw=0.6, ls=style.DASHES[1], zorder=0)
        axes.text(0.97, 0.9, words, ha="right", transform=axes.transAxes, fontsize=7.0)
    lower.text(
        displaced,
        lower.get_ylim()[0],
        f"  $\\Psi$ = {np.degrees(response.phase):.1f}°",
        va="bottom",
        fontsize=7.0,
    )
    style.letter(upper, "a", "displacement of the head")
    style.letter(lower, "b", "force at the head")
    return figure
