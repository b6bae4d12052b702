"""Master curves: does one law hold at all temperatures, and where on reduced frequency is something wrong?"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import conditions, read_diagnosis, read_residuals
from asphalt_nscd.reporting.figures import numbers, style

ABSENT = """No law common to all temperatures was taken,
so there are no shift factors and no master curve."""
RESIDUALS = {
    "residual_E_{}_percent": "|E*| residual (%)",
    "residual_phase_{}_deg": "phase residual (°)",
}


@style.journal
def draw(residuals: list[Path], diagnosis: list[Path]) -> Figure:
    """Draw (a) |E*|, (b) phase, (c, d) their residuals against reduced frequency, and (e) shift factors."""
    content = read_diagnosis(diagnosis)
    rung = next((rung for rung in content["ladder"] if "log10_shift" in rung), None)
    if rung is None:
        figure, axes = style.new_figure(style.SINGLE, 30.0)
        axes.set_axis_off()
        axes.text(0.5, 0.5, ABSENT, ha="center", va="center", transform=axes.transAxes)
        return figure
    shift = {float(t): value for t, value in rung["log10_shift"].items()}
    cells = conditions(read_residuals(residuals), content["scatter"])
    cells["reduced_Hz"] = cells["frequency_Hz"] * 10.0 ** cells["temperature_C"].map(shift)
    figure, panels = style.new_figure(style.SINGLE, 200.0, rows=5)
    norm, phase, off_norm, off_phase, shifts = panels
    temperatures = sorted(shift)
    for temperature, (colour, marker) in zip(temperatures, style.series(len(temperatures)), strict=True):
        rows = cells[cells["temperature_C"] == temperature].sort_values("frequency_Hz")
        for axes, measured, simulated, scale in (
            (norm, "E_MPa", "E_after_MPa", 1e-3),
            (phase, "phase_deg", "phase_after_deg", 1.0),
        ):
            axes.plot(rows["reduced_Hz"], rows[simulated] * scale, color=colour, lw=1.0)
            _points(axes, rows, rows[measured] * scale, colour, marker, filled=False)
        for axes, column in zip((off_norm, off_phase), RESIDUALS, strict=True):
            _points(axes, rows, rows[column.format("before")], colour, marker, filled=False)
            _points(axes, rows, rows[column.format("after")], colour, marker, filled=True)
        shifts.plot(temperature, shift[temperature], marker=marker, color=colour, ls="")
    norm.set_yscale("log")
    style.plain_log_axis(norm.yaxis)
    norm.set_ylabel("|E*| (GPa)")
    phase.set_ylabel("phase angle (°)")
    for axes, words, sigma in zip(
        (off_norm, off_phase), RESIDUALS.values(), _scatter_of_means(content, cells), strict=True
    ):
        axes.axhspan(-NOTABLE * sigma, NOTABLE * sigma, color=style.PALE, lw=0.0, alpha=0.6, zorder=0)
        axes.set_ylabel(words)
    reference = min(shift, key=lambda t: abs(shift[t]))  # where a_T is one
    for axes in panels[:4]:
        axes.set_xscale("log")
        axes.sharex(norm)
    off_phase.set_xlabel(f"reduced frequency (Hz), at {numbers.celsius(reference)}")
    shifts.set_xlabel("temperature (°C)")
    shifts.set_ylabel("log10 shift factor")
    for axes, panel, words in zip(
        panels,
        "abcde",
        ("", "", *[f"{content['origin']} − simulated"] * 2, "shift factors"),
        strict=True,
    ):
        style.letter(axes, panel, words, pad=3.0)
    style.isotherm_legends(figure, _keys(content["origin"]), temperatures)
    return figure


def _points(
    axes: Axes, rows: pd.DataFrame, values: pd.Series, colour: Any, marker: str, filled: bool
) -> None:
    face = colour if filled else "white"
    axes.plot(rows["reduced_Hz"], values, ls="", marker=marker, color=colour, markerfacecolor=face, ms=3.6)


def _scatter_of_means(content: dict[str, Any], cells: pd.DataFrame) -> list[float]:
    """Standard deviation of the mean of the least repeated condition: |E*| in percent, phase in degrees."""
    scatter = content["scatter"]
    return [scatter[name] / np.sqrt(cells["count"].min()) for name in ("modulus_percent", "phase_deg")]


def _keys(origin: str) -> list[Line2D]:
    point: dict[str, Any] = {"ls": "", "marker": "o", "color": style.INK, "ms": 3.6}
    return [
        Line2D([], [], **point, markerfacecolor="white", label=f"a, b: {origin}"),
        Line2D([], [], color=style.INK, lw=1.0, label="a, b: simulated after"),
        Line2D([], [], **point, markerfacecolor="white", label="c, d: before"),
        Line2D([], [], **point, label=f"c, d: after (grey: {NOTABLE:g} s.d.)"),
    ]
