"""Black diagram and Cole-Cole plane: where on the material's own curve simulation and measurement part."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.written import conditions, read_diagnosis, read_residuals
from asphalt_nscd.reporting.figures import style

LINES: dict[str, dict[str, Any]] = {"before": {"lw": 0.8, "ls": (0, (2.5, 1.5))}, "after": {"lw": 1.1}}
COLUMNS = {"measured": ("E_MPa", "phase_deg")}
COLUMNS |= {when: (f"E_{when}_MPa", f"phase_{when}_deg") for when in LINES}


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path]) -> Figure:
    """Draw (a) |E*| against phase, (b) loss against storage modulus; points are measured, lines simulated."""
    content = read_diagnosis(diagnosis)
    cells = conditions(read_residuals(residuals), content["scatter"])
    figure, (black, cole) = style.new_figure(style.SINGLE, 150.0, rows=2)
    temperatures = sorted(cells["temperature_C"].unique())
    looks = style.series(len(temperatures))
    for temperature, (colour, marker) in zip(temperatures, looks, strict=True):
        rows = cells[cells["temperature_C"] == temperature].sort_values("frequency_Hz")
        _isotherm(black, rows, lambda norm, phase: (np.degrees(phase), norm), colour, marker)
        _isotherm(
            cole, rows, lambda norm, phase: (norm * np.cos(phase), norm * np.sin(phase)), colour, marker
        )
    black.set_yscale("log")
    style.plain_log_axis(black.yaxis)
    black.set_xlabel("phase angle (°)")
    black.set_ylabel("|E*| (GPa)")
    cole.set_xlabel("storage modulus E1 (GPa)")
    cole.set_ylabel("loss modulus E2 (GPa)")
    style.letter(black, "a", "Black diagram")
    style.letter(cole, "b", "Cole-Cole plane")
    style.isotherm_legends(figure, _keys(content["origin"]), temperatures)
    return figure


def _isotherm(axes: Axes, rows: pd.DataFrame, plane: Callable[..., Any], colour: Any, marker: str) -> None:
    for what, (norm, phase) in COLUMNS.items():
        x, y = plane(rows[norm].to_numpy() / 1e3, np.radians(rows[phase].to_numpy()))
        if what == "measured":
            axes.plot(x, y, ls="", marker=marker, color=colour, markerfacecolor="white", zorder=3)
        else:
            axes.plot(x, y, color=colour, **LINES[what])


def _keys(origin: str) -> list[Line2D]:
    point: dict[str, Any] = {"ls": "", "marker": "o", "markerfacecolor": "white"}
    keys = [Line2D([], [], color=style.INK, label=origin, **point)]
    return keys + [
        Line2D([], [], color=style.INK, label=f"simulated {when}", **LINES[when]) for when in LINES
    ]
