"""Fig. 6: force at the head for several time steps, solved, and by sweeps that end when reactions seem stable."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.files.store import Record, load
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.reporting.figures.records import last_cycle


@style.journal
def draw(solved: list[Path], part: list[Path], stopped: list[Path]) -> Figure:
    """Draw force (a) with every step solved, (b) swept to the finest tolerance; (c) |E*| of sweeps over the solved one.

    `solved` are tests of a sample, every step solved; `stopped` are tests of a smaller specimen by Gauss-Seidel, and
    `part` is the test of that specimen, solved.
    """
    true = load(only_file(part, "part"), "test")
    swept = [load(path, "test") for path in stopped]
    tolerances = sorted({_tolerance(one) for one in swept}, reverse=True)
    figure, (left, middle, right) = style.new_figure(style.WIDE, 62.0, columns=3)
    whole = sorted((load(path, "test") for path in solved), key=_step, reverse=True)
    # The last has the shortest step, against which the others are held.
    _forces(left, whole, whole[-1])
    finest = sorted((one for one in swept if _tolerance(one) == tolerances[-1]), key=_step, reverse=True)
    _forces(middle, finest, true)
    style.letter(left, "a", "each step solved")
    style.letter(middle, "b", f"swept to {numbers.power(tolerances[-1])}")
    style.letter(right, "c", "swept")
    for tolerance, (colour, marker) in zip(tolerances, style.series(len(tolerances)), strict=True):
        rows = sorted((_step(one), _ratio(one, true)) for one in swept if _tolerance(one) == tolerance)
        right.plot(*np.transpose(rows), color=colour, marker=marker, label=numbers.power(tolerance))
    right.axhline(1.0, color=style.GREY, lw=0.8, label="solved")
    right.set(xscale="log", yscale="log", xlabel="time step $dt$ (µs)", ylabel="|E*| over solved")
    right.minorticks_off()
    steps = sorted({_step(one) for one in swept})
    right.set_xticks(steps, [f"{1e6 * step:g}" for step in steps])
    right.set_ylim(0.02 * min(_ratio(one, true) for one in swept), 3.0)
    right.legend(title="tolerance", loc="lower left", title_fontsize=7.0, borderpad=0.1)
    return figure


def _forces(axes: Axes, records: Sequence[Record], reference: Record) -> None:
    """Draw last cycles over the amplitude of the reference; coarse steps thick and light, fine ones thin and dark."""
    scale = np.ptp(last_cycle(reference)[2]) / 2.0
    for rank, (record, (colour, _)) in enumerate(zip(records, style.series(len(records))[::-1], strict=True)):
        time, _, force = last_cycle(record)
        axes.plot(
            1e3 * (time - time[0]),
            force / scale,
            color=colour,
            lw=3.0 - 2.2 * rank / max(1, len(records) - 1),
            label=f"{1e6 * _step(record):g} µs",
            zorder=2 + rank,
        )
    axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
    largest = max(np.abs(last_cycle(record)[2]).max() for record in records) / scale
    axes.set(xlabel="time from rest (ms)", ylabel="force over solved amplitude")
    # Room for the legend below the curves, which fill the rest.
    axes.set_ylim(-2.4 * largest, 1.15 * largest)
    axes.legend(title="$dt$", loc="lower left", title_fontsize=7.0, borderpad=0.1, handlelength=1.5)


def _ratio(record: Record, true: Record) -> float:
    return float(record.attributes["E_MPa"] / true.attributes["E_MPa"])


def _tolerance(record: Record) -> float:
    return float(record.attributes["tolerance"])


def _step(record: Record) -> float:
    return float(record.attributes["time_step_s"])
