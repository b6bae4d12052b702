"""Where modulus and phase contradict each other: phase measured less the phase that |E*| requires."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.written import read_causality, read_diagnosis
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.reporting.figures import cells, numbers, style

ACROSS = 3  # panels of a row
HEAD, CELL = 30.0, 5.5  # mm: what stands around the panels of a row, and an isotherm
CLEAR = 2.0  # standard errors, from which a number is bold
OUT: dict[str, Any] = {"marker": "X", "mfc": "white", "mec": style.INK, "ms": 6.0, "mew": 0.8, "ls": "none"}
IN_USE: dict[str, Any] = {
    "marker": "o",
    "mfc": "white",
    "mec": style.INK,
    "ms": 4.0,
    "mew": 0.8,
    "ls": "none",
}
# Corner of the cell [its width, its height] where a mark leaves the number free.
SUSPECT_AT, FLAG_AT = (0.18, 0.24), (0.85, 0.8)
FLAG: dict[str, Any] = {"marker": "^", "mfc": style.INK, "mec": "white", "ms": 3.2, "mew": 0.3, "ls": "none"}
NONE = "No isotherm has the four tests needed to compare modulus and phase."


@style.journal
def draw(causality: list[Path], diagnosis: list[Path]) -> Figure:
    """One panel for each specimen, one cell for each test; all share one scale, symmetric about zero.

    Parameters
    ----------
    causality : list of path
        causality.csv.
    diagnosis : list of path
        diagnosis.json.

    Returns
    -------
    Figure
        In the size of a journal column.
    """
    content, tests = read_diagnosis(diagnosis), read_causality(causality)
    tests["difference"] = tests["phase_deg"] - tests["phase_required_deg"]
    specimens = tests["specimen"].unique()
    isotherms = tests["temperature_C"].nunique()
    columns = min(ACROSS, specimens.size)
    rows = -(-specimens.size // columns)
    width = style.SINGLE if columns == 1 else style.WIDE
    figure, panels = style.new_figure(
        width, 14.0 + rows * (HEAD + CELL * isotherms), rows, columns, sharex=True, sharey=True, squeeze=False
    )
    if tests["difference"].isna().all():
        figure.clear()
        figure.text(0.5, 0.5, NONE, ha="center", va="center")
        return figure
    # The size of one degree is seen on the worst table too.
    norm = cells.banded(max(float(tests["difference"].abs().max()), 1.0))
    for axes, name in zip(panels.flat, specimens, strict=False):
        image = _panel(axes, tests[tests["specimen"] == name], tests, norm)
        axes.set_title(specimen_named(name), fontsize=8.0, pad=3.0)
    for axes in panels.flat[specimens.size :]:
        axes.remove()
    for axes in panels[:, 0]:
        axes.set_ylabel("temperature (°C)")
    for axes in panels.flat[max(specimens.size - columns, 0) : specimens.size]:
        axes.set_xlabel("frequency (Hz)")
        axes.tick_params(labelbottom=True)
    bar = figure.colorbar(
        image, ax=list(panels.flat[: specimens.size]), orientation="horizontal", aspect=50, pad=0.02
    )
    limit = norm.boundaries[-1]
    bar.set_label(f"phase {content['origin']} \N{MINUS SIGN} phase that |E*| requires (°), scale ±{limit:g}°")
    bar.ax.set_xticks(norm.boundaries, [numbers.minus(f"{edge:g}") for edge in norm.boundaries])
    bar.ax.tick_params(labelsize=6.0, length=1.5)
    keys = [
        Line2D([], [], label="suspect, not used", **OUT),
        Line2D([], [], label="suspect, used", **IN_USE),
        Line2D([], [], label="quality limit exceeded", **FLAG),
        Line2D(
            [],
            [],
            ls="none",
            marker=r"$\mathbf{0.0}$",
            color=style.INK,
            ms=9.0,
            label=f"beyond {CLEAR:g} standard errors",
        ),
    ]
    figure.legend(
        handles=keys,
        loc="outside upper left",
        ncols=2 if columns == 1 else 4,
        borderpad=0.1,
        handlelength=1.2,
        columnspacing=1.2,
        title=f"{content['origin']} data",
        title_fontsize=7.0,
        alignment="left",
    )
    return figure


def _panel(axes: Axes, own: pd.DataFrame, tests: pd.DataFrame, norm: BoundaryNorm) -> QuadMesh:
    temperatures, frequencies = (np.unique(tests[name]) for name in ("temperature_C", "frequency_Hz"))
    places = {"index": "temperature_C", "columns": "frequency_Hz"}
    # Amplitudes share a cell, which shows the worst.
    worst = own.sort_values("difference", key=abs).drop_duplicates(list(places.values()), keep="last")
    table, error = (
        worst.pivot(values=name, **places).reindex(index=temperatures, columns=frequencies)
        for name in ("difference", "std_error_deg")
    )
    clear = (table.abs() >= CLEAR * error).to_numpy()
    image = cells.draw_table(axes, table, norm, clear)
    suspect = own["reasons"].ne("")
    for chosen, at, look in (
        (suspect & ~own["used"], SUSPECT_AT, OUT),
        (suspect & own["used"], SUSPECT_AT, IN_USE),
        (own["quality_flag"], FLAG_AT, FLAG),
    ):
        x = np.searchsorted(frequencies, own["frequency_Hz"][chosen]) + at[0]
        y = np.searchsorted(temperatures, own["temperature_C"][chosen]) + at[1]
        axes.plot(x, y, zorder=3, **look)
    return image
