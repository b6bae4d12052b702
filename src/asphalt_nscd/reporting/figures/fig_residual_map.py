"""Where simulation and measurement differ: residuals over temperature and frequency, before and after."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import BEFORE_AFTER, RESIDUALS, conditions, read_diagnosis, read_residuals
from asphalt_nscd.reporting.figures import numbers, style

COLOURS = "RdBu_r"
BANDS = 5  # steps of 1, 2, 5, ... on either side of zero
MOST_NUMBERED = 8  # columns whose cells have room for a number
MOST_LABELS = 8
ROWS = {
    "E": ("|E*| {} − simulated (%)", "modulus_percent"),
    "phase": ("phase {} − simulated (°)", "phase_deg"),
}


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path]) -> Figure:
    """Draw one cell for each condition: |E*| above, phase below; each quantity has one scale for before and after."""
    content = read_diagnosis(diagnosis)
    means = conditions(read_residuals(residuals), content["scatter"])
    figure, panels = style.new_figure(style.SINGLE, 112.0, rows=2, columns=2, sharex=True, sharey=True)
    letters = iter("abcd")
    for row, (quantity, (words, scatter)) in zip(panels, ROWS.items(), strict=True):
        columns = [RESIDUALS[quantity].format(when) for when in BEFORE_AFTER]
        # Scatter alone must look pale.
        norm = _banded(max(float(means[columns].abs().max().max()), NOTABLE * content["scatter"][scatter]))
        for axes, when, column in zip(row, BEFORE_AFTER, columns, strict=True):
            image = _map(axes, means, column, norm)
            style.letter(axes, next(letters), when)
        bar = figure.colorbar(
            image, ax=list(row), orientation="horizontal", fraction=0.06, aspect=40, pad=0.02
        )
        bar.set_label(words.format(content["origin"]))
        bar.ax.set_xticks(norm.boundaries, [numbers.minus(f"{edge:g}") for edge in norm.boundaries])
        bar.ax.tick_params(labelsize=6.0, length=1.5)
    for axes in panels[1]:
        axes.set_xlabel("frequency (Hz)")
        axes.tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        axes.set_ylabel("temperature (°C)")
    marked = Patch(
        facecolor="none", edgecolor=style.INK, label=f"beyond {NOTABLE:g} standard deviations of replicates"
    )
    figure.legend(
        handles=[marked],
        loc="outside upper left",
        title=f"{content['origin']} data, means over specimens",
        title_fontsize=7.0,
        alignment="left",
        borderpad=0.1,
    )
    return figure


def _banded(largest: float) -> BoundaryNorm:
    """Bands 1, 2, 5, 10, ... about zero that reach the largest value."""
    steps = np.array([m * 10.0**e for e in range(-6, 6) for m in (1, 2, 5)])
    last = int(np.searchsorted(steps, largest))
    edges = steps[last - BANDS + 1 : last + 1]
    return BoundaryNorm(np.concatenate([-edges[::-1], edges]), colormaps[COLOURS].N)


def _map(axes: Axes, conditioned: pd.DataFrame, column: str, norm: BoundaryNorm) -> QuadMesh:
    """A cell for each condition, with its number where they are few; a frame about what is beyond scatter."""
    places = {"index": "temperature_C", "columns": "frequency_Hz"}
    table = conditioned.pivot(values=column, **places)
    beyond = conditioned.pivot(values=f"z_{column}", **places).abs() > NOTABLE
    axes.set_facecolor(style.PALE)  # shows where nothing was tested
    image = axes.pcolormesh(table.to_numpy(), cmap=COLOURS, norm=norm, edgecolors="white", linewidth=0.5)
    for (i, k), value in np.ndenumerate(table.to_numpy()):
        if np.isfinite(value) and table.shape[1] <= MOST_NUMBERED:
            red, green, blue, _ = image.cmap(norm(value))
            # By the brightness of the cell, to which green adds most.
            colour = "white" if 0.3 * red + 0.6 * green + 0.1 * blue < 0.5 else style.INK
            digits = 0 if abs(value) >= 9.95 else 1
            # + 0.0 makes a 0 of what is rounded to -0.
            number = numbers.minus(f"{round(value, digits) + 0.0:.{digits}f}")
            axes.text(k + 0.5, i + 0.5, number, ha="center", va="center", fontsize=5.5, color=colour)
    for axis, values in ((axes.xaxis, table.columns), (axes.yaxis, table.index)):
        every = -(-len(values) // MOST_LABELS)
        labels = [numbers.minus(f"{value:g}") for value in values]
        axis.set_ticks(np.arange(len(values))[::every] + 0.5, labels[::every])
        axis.set_tick_params(length=0.0)
    for i, k in np.argwhere(beyond.to_numpy()):
        axes.add_patch(Rectangle((k + 0.06, i + 0.06), 0.88, 0.88, fill=False, edgecolor=style.INK, lw=0.8))
    return image
