"""Height of the layer against time while the top wall vibrates it."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from asphalt_nscd.files.store import load
from asphalt_nscd.reporting.figures import style


@style.journal
def draw(deposit: list[Path]) -> Figure:
    """Draw one curve for each sample, from the poured layer to the vibrated one at rest."""
    figure, axes = style.new_figure(style.SINGLE, 60.0)
    for path, (colour, marker) in zip(deposit, style.series(len(deposit)), strict=True):
        course = load(path, "deposit").arrays
        time, height = course["course/time"], 1e3 * course["course/height"]
        if time.size:  # it was vibrated
            axes.plot(time - time[0], height, color=colour, lw=0.8, label=f"sample {path.stem}")
            axes.plot(time[-1] - time[0], height[-1], ls="", marker=marker, ms=3.2, color=colour)
    axes.set_xlabel("time from the start of the vibration (s)")
    axes.set_ylabel("height of the layer (mm)")
    if axes.lines:
        axes.legend(loc="best")
    return figure
