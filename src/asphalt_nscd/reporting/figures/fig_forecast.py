"""Forecast against measured: six mixes whose binder was measured too."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures import style

FORECAST = "forecast"
SHOWN: dict[str, tuple[str, str, Any, float]] = {
    FORECAST: ("forecast", style.BLUE, "-", 1.6),
    "hirsch": ("Hirsch", style.GREY, (0, (5, 1.5)), 0.9),
    "differential": ("volumes alone", style.GREY, (0, (1.2, 1.2)), 0.9),
}


@style.journal
def draw(points: list[Path]) -> Figure:
    """Draw points.csv of the rule `forecast_mixes`: |E*| above, phase below, a column for each mix."""
    frame = pd.read_csv(points[0])
    mixes = list(dict.fromkeys(frame["mix"]))
    figure, axes = style.new_figure(style.WIDE, 88.0, rows=2, columns=len(mixes), sharex=True, sharey="row")
    for (norm, phase), mix in zip(axes.T, mixes, strict=True):
        of_mix = frame[frame["mix"] == mix]
        measured = of_mix[of_mix["forecast"] == FORECAST]
        point = {"ls": "", "marker": "o", "ms": 2.2, "color": style.ORANGE}
        norm.plot(
            measured["omega_rad_s"], measured["measured_E_MPa"], **point, label="measured (published law)"
        )
        phase.plot(measured["omega_rad_s"], measured["measured_phase_deg"], **point)
        for name, (label, colour, dash, width) in SHOWN.items():
            rows = of_mix[of_mix["forecast"] == name]
            norm.plot(rows["omega_rad_s"], rows["E_MPa"], color=colour, ls=dash, lw=width, label=label)
            phase.plot(rows["omega_rad_s"], rows["phase_deg"], color=colour, ls=dash, lw=width)
        norm.set_xscale("log")
        norm.set_yscale("log")
        norm.set_title(mix, fontsize=8.0)
        phase.set_xlabel("ω (rad/s)")
    axes[0, 0].set_ylim(10.0, 4e4)
    axes[0, 0].set_ylabel("|E*| (MPa)")
    axes[1, 0].set_ylim(0.0, 90.0)
    axes[1, 0].set_ylabel("phase angle (°)")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure
