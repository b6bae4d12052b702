"""Maps over temperature and frequency: one cell for each condition, coloured about zero, with its number."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm
from numpy.typing import NDArray

from asphalt_nscd.reporting.figures import numbers, style

COLOURS = "RdBu_r"
BANDS = 5  # steps of 1, 2, 5, ... on either side of zero
MOST_NUMBERED = 8  # columns whose cells have room for a number
MOST_LABELS = 8


def banded(largest: float) -> BoundaryNorm:
    """Bands 1, 2, 5, 10, ... about zero that reach the largest value.

    Parameters
    ----------
    largest : float
        Of the values.

    Returns
    -------
    BoundaryNorm
        Of colours.
    """
    steps = np.array([m * 10.0**e for e in range(-6, 6) for m in (1, 2, 5)])
    last = int(np.searchsorted(steps, largest))
    edges = steps[last - BANDS + 1 : last + 1]
    return BoundaryNorm(np.concatenate([-edges[::-1], edges]), colormaps[COLOURS].N)


def draw_table(
    axes: Axes, table: pd.DataFrame, norm: BoundaryNorm, bold: NDArray[np.bool_] | None = None
) -> QuadMesh:
    """Cells of a table with numbers where they are few.

    Parameters
    ----------
    axes : Axes
        To draw on.
    table : DataFrame
        Index degC, columns Hz.
    norm : BoundaryNorm
        Of colours.
    bold : ndarray of bool, optional
        Whose numbers are heavy.

    Returns
    -------
    QuadMesh
        For a colour bar.
    """
    axes.set_facecolor(style.PALE)  # shows where nothing was tested
    image = axes.pcolormesh(table.to_numpy(), cmap=COLOURS, norm=norm, edgecolors="white", linewidth=0.5)
    for (i, k), value in np.ndenumerate(table.to_numpy()):
        if np.isfinite(value) and table.shape[1] <= MOST_NUMBERED:
            red, green, blue, _ = image.cmap(norm(value))
            dark = 0.3 * red + 0.6 * green + 0.1 * blue < 0.5
            digits = 0 if abs(value) >= 9.95 else 1
            axes.text(
                k + 0.5,
                i + 0.5,
                numbers.minus(f"{round(value, digits) + 0.0:.{digits}f}"),
                ha="center",
                va="center",
                fontsize=5.5,
                color="white" if dark else style.INK,
                fontweight="bold" if bold is not None and bold[i, k] else "normal",
            )
    for axis, values in ((axes.xaxis, table.columns), (axes.yaxis, table.index)):
        every = -(-len(values) // MOST_LABELS)
        labels = [numbers.minus(f"{value:g}") for value in values]
        axis.set_ticks(np.arange(len(values))[::every] + 0.5, labels[::every])
        axis.set_tick_params(length=0.0)
    return image
