"""Fig. 6: force at the head over one cycle for several time steps, converged and stopped early."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.errors import InputError
from asphalt_nscd.figures import style
from asphalt_nscd.figures.records import last_cycle
from asphalt_nscd.store import Record, load


@style.journal
def draw(converged: Sequence[Path] = (), stopped: Sequence[Path] = ()) -> Figure:
    """(a) Steps solved to the end; (b) Gauss-Seidel on the bonds stopped early, as its own criterion lets it."""
    panels = [
        (sorted((load(path, "test") for path in paths), key=_step), text)
        for paths, text in ((converged, "each step solved"), (stopped, "Gauss-Seidel stopped early"))
        if paths
    ]
    if not panels:
        raise InputError("no test to draw; give converged, stopped, or both.")
    figure, axes = style.new_figure(
        style.WIDE if len(panels) == 2 else style.SINGLE, 66.0, columns=len(panels), sharey=True, squeeze=False
    )
    for place, panel, (records, text) in zip(axes[0], "ab", panels, strict=False):
        _panel(place, records)
        style.letter(place, panel, text)
    axes[0, 0].set_ylabel("force at the head (N)")
    return figure


def _panel(axes: Axes, records: list[Record]) -> None:
    amplitudes = []
    # Coarse steps thick and light below fine ones thin and dark: curves that coincide stay visible.
    for rank, (record, (colour, _)) in enumerate(zip(records[::-1], style.series(len(records))[::-1], strict=True)):
        time, _, force = last_cycle(record)
        amplitudes.append(np.ptp(force) / 2.0)
        axes.plot(
            1e3 * time, force, color=colour, lw=3.2 - 2.4 * rank / max(1, len(records) - 1),
            ls=style.DASHES[(len(records) - 1 - rank) % len(style.DASHES)] if rank else "-",
            label=f"$dt$ = {_scientific(_step(record))} s", zorder=2 + rank,
        )  # fmt: skip
    change = 100.0 * (max(amplitudes) / min(amplitudes) - 1.0)
    axes.axhline(0.0, color=style.PALE, lw=0.5, zorder=0)
    axes.set_xlabel("time in the cycle (ms)")
    axes.set_xlim(0.0, 1e3 / records[0].attributes["frequency_Hz"])
    legend = axes.legend(loc="upper right", title=f"amplitudes within {change:.2g} %", title_fontsize=7.0)
    legend._legend_box.align = "left"


def _step(record: Record) -> float:
    return float(record.attributes["time_step_s"])


def _scientific(value: float) -> str:
    power = int(np.floor(np.log10(value) + 1e-9))
    return rf"${value / 10.0**power:g}\times10^{{{power}}}$"
