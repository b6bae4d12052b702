"""Fig. 6: force at the head over one cycle for several time steps, converged and stopped early."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.reporting.figures.records import last_cycle

COMPARABLE = 5.0  # ratio of forces up to which the panels share one scale
JOLT = 0.05  # of a cycle: where it begins from rest, the scale does not follow the first few steps


@style.journal
def draw(converged: Sequence[Path] = (), stopped: Sequence[Path] = ()) -> Figure:
    """(a) Every step solved to the end; (b) Gauss-Seidel on the bonds stopped before it converged."""
    panels = [
        (sorted((load(path, "test") for path in paths), key=_step, reverse=True), text)
        for paths, text in ((converged, "each step solved"), (stopped, "Gauss-Seidel stopped"))
        if paths
    ]
    if not panels:
        raise InputError("no test to draw; give converged, stopped, or both.")
    figure, axes = style.new_figure(
        style.WIDE if len(panels) == 2 else style.SINGLE, 70.0, columns=len(panels), squeeze=False
    )
    extents = [max(map(_extent, records)) for records, _ in panels]
    frequencies = {record.attributes["frequency_Hz"] for records, _ in panels for record in records}
    comparable = len(frequencies) == 1 and max(extents) < COMPARABLE * min(extents)
    for place, name, (records, text), extent in zip(axes[0], "ab", panels, extents, strict=False):
        if comparable:
            extent = max(extents)
        _panel(place, records, extent)
        style.letter(place, name, f"{text}, {records[0].attributes['frequency_Hz']:g} Hz")
    if comparable and len(panels) == 2:
        time, _, force = last_cycle(panels[0][0][-1])
        axes[0, 1].plot(1e3 * time, force, color=style.GREY, lw=0.6, zorder=1, label="solved, finest $dt$")
    for place in axes[0]:
        place.legend(loc="upper right", borderpad=0.1)
    return figure


def _panel(axes: Axes, records: list[Record], extent: float) -> None:
    """Coarse steps thick and light below fine ones thin and dark: curves that coincide stay visible."""
    amplitudes = []
    for rank, (record, (colour, _)) in enumerate(zip(records, style.series(len(records))[::-1], strict=True)):
        time, _, force = last_cycle(record)
        amplitudes.append(np.ptp(_settled(record)) / 2.0)
        dash = style.DASHES[-rank % len(records) % len(style.DASHES)]
        axes.plot(
            1e3 * time,
            force,
            color=colour,
            ls=dash,
            lw=3.0 - 2.2 * rank / max(1, len(records) - 1),
            label=f"$dt$ = {numbers.power(_step(record))} s",
            zorder=2 + rank,
        )
    axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
    axes.set_xlabel("time in the last cycle (ms)")
    axes.set_ylabel("force at the head (N)")
    axes.set_xlim(0.0, 1e3 / records[0].attributes["frequency_Hz"])
    axes.set_ylim(-1.4 * extent, 1.15 * extent)
    axes.text(0.03, 0.03, _agreement(amplitudes), transform=axes.transAxes, fontsize=7.0)


def _settled(record: Record) -> np.ndarray:
    """Force of the last cycle [N] without its first steps."""
    time, _, force = last_cycle(record)
    return force[time > JOLT / record.attributes["frequency_Hz"]]


def _extent(record: Record) -> float:
    return float(np.abs(_settled(record)).max())


def _agreement(amplitudes: list[float]) -> str:
    ratio = max(amplitudes) / min(amplitudes)
    if ratio < 2.0:
        return f"amplitudes agree to {_rounded(100.0 * (ratio - 1.0))} %"
    return f"amplitudes differ by a factor of {_rounded(ratio)}"


def _rounded(value: float) -> str:
    """Two digits, without a power of ten."""
    return f"{float(f'{value:.2g}'):g}"


def _step(record: Record) -> float:
    return float(record.attributes["time_step_s"])
