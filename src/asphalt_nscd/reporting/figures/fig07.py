"""Fig. 7: displacement imposed at the head and the force it takes, over the last cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.measurements.tables import the_only
from asphalt_nscd.reporting.figures import style
from asphalt_nscd.reporting.figures.records import last_cycle


@style.journal
def draw(test: list[Path]) -> Figure:
    """Two scales with one zero; the amplitudes and the lag are those of the harmonic fit."""
    record = load(the_only(test, "test"), "test")
    frequency = record.attributes["frequency_Hz"]
    time, displacement, force = last_cycle(record)
    history = record.arrays["time_s"], record.arrays["force_N"], record.arrays["displacement_m"]
    response = harmonic_response(*history, frequency, cycles=1)
    milliseconds, micrometres = 1e3 * time, 1e6 * displacement

    figure, axes = style.new_figure(style.SINGLE, 62.0)
    right = axes.twinx()
    right.spines["right"].set_visible(True)
    axes.plot(milliseconds, micrometres, color=style.ORANGE, ls=style.DASHES[1])
    right.plot(milliseconds, force, color=style.BLUE)
    axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
    axes.set_xlabel("time in the last cycle (ms)")
    axes.set_ylabel("displacement of the head (µm)", color=_darker(style.ORANGE))
    right.set_ylabel("force at the head (N)", color=style.BLUE)
    axes.set_xlim(0.0, 1e3 / frequency)
    for panel, values in ((axes, micrometres), (right, force)):
        panel.set_ylim(*(1.3 * np.abs(values).max() * np.array([-1.0, 1.0])))

    # The force leads, so its crest comes first.
    displaced = 1e3 * time[np.argmax(displacement)]
    lead = 1e3 * response.phase / (2.0 * np.pi * frequency)
    crest, level = displaced - lead, 1.16 * response.force_amplitude
    for at in (crest, displaced):
        right.plot(
            [at, at], [response.force_amplitude, 1.2 * response.force_amplitude], color=style.INK, lw=0.5
        )
    right.annotate(
        f"$\\Psi$ = {np.degrees(response.phase):.1f}°",
        (displaced, level),
        xytext=(6.0, 0.0),
        textcoords="offset points",
        va="center",
        fontsize=7.0,
    )
    right.plot([crest, displaced], [level, level], color=style.INK, lw=0.8)
    figure.legend(
        [axes.lines[0], right.lines[0]],
        [
            f"displacement, $z_0$ = {1e6 * response.displacement_amplitude:.3g} µm",
            f"force, $F_0$ = {response.force_amplitude:.3g} N",
        ],
        loc="outside upper left",
        ncols=2,
        borderpad=0.1,
    )
    return figure


def _darker(colour: str) -> str:
    return {style.ORANGE: "#9c5510"}[colour]
