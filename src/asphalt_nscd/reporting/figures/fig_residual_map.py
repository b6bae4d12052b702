"""Where simulation and measurement differ: residuals over temperature and frequency, before and after."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import (
    BEFORE_AFTER,
    RESIDUALS,
    conditions,
    read_diagnosis,
    read_residuals,
)
from asphalt_nscd.reporting.figures import cells, numbers, style

ROWS = {
    "E": ("|E*| {} − simulated (%)", "modulus_percent"),
    "phase": ("phase {} − simulated (°)", "phase_deg"),
}


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path]) -> Figure:
    """One cell for each condition: |E*| above, phase below; each quantity has one scale for before and after.

    Parameters
    ----------
    residuals : list of path
        residuals.csv.
    diagnosis : list of path
        diagnosis.json.

    Returns
    -------
    Figure
        In the size of a journal column.
    """
    content = read_diagnosis(diagnosis)
    means = conditions(read_residuals(residuals), content["scatter"])
    figure, panels = style.new_figure(style.SINGLE, 112.0, rows=2, columns=2, sharex=True, sharey=True)
    letters = iter("abcd")
    for row, (quantity, (words, scatter)) in zip(panels, ROWS.items(), strict=True):
        columns = [RESIDUALS[quantity].format(when) for when in BEFORE_AFTER]
        # Scatter alone must look pale.
        norm = cells.banded(
            max(float(means[columns].abs().max().max()), NOTABLE * content["scatter"][scatter])
        )
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


def _map(axes: Axes, conditioned: pd.DataFrame, column: str, norm: BoundaryNorm) -> QuadMesh:
    places = {"index": "temperature_C", "columns": "frequency_Hz"}
    beyond = conditioned.pivot(values=f"z_{column}", **places).abs() > NOTABLE
    image = cells.draw_table(axes, conditioned.pivot(values=column, **places), norm)
    for i, k in np.argwhere(beyond.to_numpy()):
        axes.add_patch(Rectangle((k + 0.06, i + 0.06), 0.88, 0.88, fill=False, edgecolor=style.INK, lw=0.8))
    return image
