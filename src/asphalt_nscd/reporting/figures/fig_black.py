"""Black diagram and Cole-Cole plane: where on the material's own curve simulation and measurement part."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.written import conditions, read_diagnosis, read_residuals
from asphalt_nscd.reporting.figures import panels, style

Looks: TypeAlias = dict[Any, tuple[Any, str]]
Lines: TypeAlias = dict[str, dict[str, Any]]
AFTER: Lines = {"after": {"lw": 1.0}}
LINES: Lines = {"before": {"lw": 0.7, "ls": (0, (2.5, 1.5))}} | AFTER


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path]) -> Figure:
    """Draw (a) |E*| against phase, (b) loss against storage modulus; points are measured, lines simulated."""
    content, tests = read_diagnosis(diagnosis), read_residuals(residuals)
    means = conditions(tests, content["scatter"])
    figure, (upper, lower) = style.new_figure(style.SINGLE, 150.0, rows=2)
    temperatures = sorted(tests["temperature_C"].unique())
    looks = dict(zip(temperatures, style.series(len(temperatures)), strict=True))
    black(upper, tests.assign(group=tests["temperature_C"]), means, looks)
    for at, rows in tests.groupby("temperature_C"):
        panels.points(lower, *_cole(rows, ""), looks[at], rows)
    _modelled(lower, means, _cole)
    lower.set(xlabel="storage modulus E1 (GPa)", ylabel="loss modulus E2 (GPa)")
    style.letter(upper, "a", "Black diagram")
    style.letter(lower, "b", "Cole-Cole plane")
    style.isotherm_legends(figure, keys(content["origin"]), temperatures)
    return figure


def black(axes: Axes, tests: pd.DataFrame, means: pd.DataFrame, looks: Looks, lines: Lines = LINES) -> None:
    """Draw |E*| against phase: tests of each `group` by its colour and mark, and of `means` what `lines` name."""
    for name, rows in tests.groupby("group"):
        panels.points(axes, rows["phase_deg"], rows["E_MPa"] * 1e-3, looks[name], rows)
    _modelled(axes, means, lambda rows, end: (rows[f"phase{end}_deg"], rows[f"E{end}_MPa"] * 1e-3), lines)
    axes.set_xlabel(panels.QUANTITIES["phase"][2])
    panels.quantity_axis(axes, "E")


def _cole(rows: pd.DataFrame, end: str) -> tuple[np.ndarray, np.ndarray]:
    """Storage and loss modulus [GPa] of columns that end in `end`."""
    star = rows[f"E{end}_MPa"].to_numpy() * 1e-3 * np.exp(1j * np.radians(rows[f"phase{end}_deg"].to_numpy()))
    return star.real, star.imag


def _modelled(axes: Axes, means: pd.DataFrame, plane: Any, lines: Lines = LINES) -> None:
    for _, rows in means.sort_values("frequency_Hz").groupby("temperature_C"):
        for when, look in lines.items():
            axes.plot(*plane(rows, f"_{when}"), color=style.INK, zorder=2, **look)


def keys(origin: str) -> list[Line2D]:
    """Entries of a legend: points, and the two lines."""
    lines = [
        Line2D([], [], color=style.INK, label=f"simulated {when}", **look) for when, look in LINES.items()
    ]
    return [panels.key(origin, (style.INK, "o")), *lines]
